(* T5: the rule that never blames the healthy, and its fast form. Nothing here depends on geometry or noise: [alive] is
   the outcome of any test of sets. *)
From Coq Require Import Arith Bool Lia Reals Lra.
From Plumb Require Import Sets Vectors Sensors.
Open Scope nat_scope.

Section Soundness.
  Variable n : nat.
  Variable alive : set -> Prop.    (* the sets that no test has killed *)

  (* s_i > m in words: no live set with at most m sensors left out has i in it. [accused m i] is that. *)
  Definition accused (m i : nat) : Prop := forall S, alive S -> S i = true -> m < card n (compl S).

  (* T5: while the healthy set is alive and at most m sensors are not healthy, nobody healthy is accused. *)
  Theorem T5_never_the_healthy (m : nat) (S0 : set) :
    alive S0 -> card n (compl S0) <= m -> forall i, S0 i = true -> ~ accused m i.
  Proof. intros A Few i Si Acc. specialize (Acc S0 A Si). lia. Qed.

  (* The same rule as the monitor words it: i is in every live fault set of at most m members. *)
  Theorem accused_is_in_every_live_fault_set (m i : nat) :
    accused m i <-> (forall S, alive S -> card n (compl S) <= m -> compl S i = true).
  Proof.
    unfold accused, compl at 3. split; intros H S A.
    - intros Le. destruct (S i) eqn:Si; [specialize (H S A Si); lia|reflexivity].
    - intros Si. destruct (le_lt_dec (card n (compl S)) m) as [L|L]; [|exact L].
      specialize (H S A L). rewrite Si in H. discriminate H.
  Qed.

  (* The fast form at the strict grade n-1-c: it is enough to look at the live sets of c+1 sensors, provided that a
     subset of a live set is alive. No enumeration of fault sets, no cap. *)
  Theorem strict_grade_by_voting_sets (c i : nat) :
    (forall A B, alive A -> subset n B A -> alive B) -> c < n -> i < n ->
    (accused (n - 1 - c) i <-> (forall S, alive S -> card n S = c + 1 -> S i = false)).
  Proof.
    intros Hereditary Cn Hi. split.
    - intros Acc S A K. destruct (S i) eqn:Si; [|reflexivity].
      specialize (Acc S A Si). pose proof (card_compl n S). lia.
    - intros Vote S A Si. pose proof (card_compl n S) as CC.
      destruct (le_lt_dec (c + 1) (card n S)) as [L|L]; [|lia]. exfalso.
      destruct (subset_of_size_with n S i (c + 1) Hi Si ltac:(lia)) as [B [BS [Bk Bi]]].
      specialize (Vote B (Hereditary S B A BS) Bk). congruence.
  Qed.

  (* s_i, the fewest sensors that must be wrong if i is healthy: what a live set with i in it leaves out, at the least. *)
  Definition fewest (s i : nat) : Prop :=
    (exists S, alive S /\ S i = true /\ card n (compl S) = s) /\
    (forall S, alive S -> S i = true -> s <= card n (compl S)).

  (* "Accused at m" is s_i > m; a sensor that is in no live set has no s_i and is accused at every m. *)
  Theorem accused_means_too_many_faults (m s i : nat) : fewest s i -> (accused m i <-> m < s).
  Proof.
    intros [[S [A [Si E]]] Least]. split; intros H.
    - specialize (H S A Si). lia.
    - intros T AT Ti. specialize (Least T AT Ti). lia.
  Qed.

  (* The same in the words of s_i. *)
  Theorem strict_grade_in_fewest_faults (c s i : nat) :
    (forall A B, alive A -> subset n B A -> alive B) -> c < n -> i < n -> fewest s i ->
    (n - 1 - c < s <-> ~ exists S, alive S /\ card n S = c + 1 /\ S i = true).
  Proof.
    intros Hereditary Cn Hi F. rewrite <- (accused_means_too_many_faults (n - 1 - c) s i F).
    rewrite (strict_grade_by_voting_sets c i Hereditary Cn Hi). split.
    - intros V [S [A [K Si]]]. specialize (V S A K). congruence.
    - intros V S A K. destruct (S i) eqn:Si; [|reflexivity]. exfalso. apply V. now exists S.
  Qed.
End Soundness.

(* T5 over an episode of stations, with noise and systematic error of every sensor within e and gravity's length known
   within d: a set is alive if at every station some vector of about the right length explains its readings. No sensor that
   was healthy at every station is accused, whatever the others did (collusion, mirrors, faults that come and go). *)
Section Episode.
  Variables (n : nat) (h : nat -> vec).
  Variables (e d G : R) (station : nat -> Prop) (y : nat -> nat -> R).

  Definition alive_throughout (S : set) : Prop :=
    forall k, station k -> exists x, (Rabs (norm x - G) <= d)%R /\
      forall i, i < n -> S i = true -> (Rabs (dot (h i) x - y k i) <= e)%R.

  Theorem T5_episode (g : nat -> vec) (m : nat) (S0 : set) :
    (forall k, station k -> (Rabs (norm (g k) - G) <= d)%R) ->
    (forall k i, station k -> i < n -> S0 i = true -> (Rabs (dot (h i) (g k) - y k i) <= e)%R) ->
    card n (compl S0) <= m ->
    forall i, S0 i = true -> ~ accused n alive_throughout m i.
  Proof.
    intros Length Healthy Few. apply T5_never_the_healthy; [|exact Few].
    intros k Hk. exists (g k). split; [now apply Length|]. intros i Hi Si. now apply Healthy.
  Qed.

  Theorem alive_throughout_hereditary (A B : set) :
    alive_throughout A -> subset n B A -> alive_throughout B.
  Proof.
    intros Al Sub k Hk. destruct (Al k Hk) as [x [L E]]. exists x. split; [exact L|].
    intros i Hi Bi. apply E; [exact Hi|]. now apply Sub.
  Qed.
End Episode.
