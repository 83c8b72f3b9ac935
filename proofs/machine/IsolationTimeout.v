(* L3 (its count): how many stations in doubt an episode has before the isolation timeout is over. The isolation timeout begins anew when more sensors
   are suspected than ever before in the episode; that number is at most n, and so are the beginnings. Nothing is assumed
   of who is suspected when. *)
From Coq Require Import List Arith Lia.
Import ListNotations.

Record count := Count { most : nat; doubt : nat }.

(* One block: so many sensors are suspected; and whether it is in doubt at an attitude that is not on record. *)
Definition block := (nat * bool)%type.
Definition note (suspected : nat) (c : count) : count := if most c <? suspected then Count suspected 0 else c.
Definition step (c : count) (b : block) : count :=
  let c := note (fst b) c in if snd b then Count (most c) (S (doubt c)) else c.

Definition stations_in_doubt (blocks : list block) : nat := length (filter snd blocks).

Section Bound.
Variables n P : nat.

Fixpoint never_over (c : count) (blocks : list block) : Prop :=
  match blocks with
  | [] => True
  | b :: rest => doubt (step c b) < P /\ never_over (step c b) rest
  end.

Definition to_go (c : count) : nat := (n - most c) * P + (P - doubt c).

Lemma every_station_takes_one c b :
  most c <= n -> fst b <= n -> doubt (step c b) < P ->
  most (step c b) <= n /\ to_go (step c b) + (if snd b then 1 else 0) <= to_go c.
Proof.
  destruct c as [m d], b as [s new]. unfold step, note, to_go. simpl. intros Hm Hs.
  destruct (m <? s) eqn:E.
  - apply Nat.ltb_lt in E. assert (n - m = (n - s) + (s - m)) as -> by lia.
    assert (P <= (s - m) * P) by (destruct (s - m) eqn:F; [lia | simpl; lia]).
    rewrite Nat.mul_add_distr_r. destruct new; simpl; intros; split; lia.
  - destruct new; simpl; intros; split; lia.
Qed.

Lemma runs_are_bounded blocks : forall c,
  most c <= n -> (forall b, In b blocks -> fst b <= n) -> never_over c blocks -> stations_in_doubt blocks <= to_go c.
Proof.
  induction blocks as [|b blocks IH]; intros c Hm Hn Hover; [apply Nat.le_0_l|].
  destruct Hover as [Hd Hrest].
  destruct (every_station_takes_one c b Hm (Hn b (or_introl eq_refl)) Hd) as [Hm' Hstep].
  specialize (IH (step c b) Hm' (fun b' H => Hn b' (or_intror H)) Hrest).
  unfold stations_in_doubt in *. simpl. destruct (snd b); simpl; lia.
Qed.

Theorem L3_isolation_timeout_is_over_within_n_plus_one_times_P blocks :
  (forall b, In b blocks -> fst b <= n) -> never_over (Count 0 0) blocks -> stations_in_doubt blocks <= (n + 1) * P.
Proof.
  intros Hn Hover. pose proof (runs_are_bounded blocks (Count 0 0) (Nat.le_0_l n) Hn Hover) as H.
  unfold to_go in H. simpl in H. lia.
Qed.
End Bound.
