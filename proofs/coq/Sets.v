(* Sets of sensors: sensors are the numbers 0 .. n-1, a set is a characteristic function, |S| is [card n S].
   Only what the theorems need: monotony, inclusion and exclusion, subsets of a wanted size. *)
From Coq Require Import Arith Bool Lia List.

Definition set := nat -> bool.

Fixpoint card (n : nat) (S : set) : nat :=
  match n with
  | O => O
  | S m => card m S + (if S m then 1 else 0)
  end.

Definition inter (A B : set) : set := fun i => A i && B i.
Definition union (A B : set) : set := fun i => A i || B i.
Definition compl (A : set) : set := fun i => negb (A i).
Definition subset (n : nat) (A B : set) : Prop := forall i, i < n -> A i = true -> B i = true.
Definition same (n : nat) (A B : set) : Prop := forall i, i < n -> A i = B i.

Lemma card_le (n : nat) (S : set) : card n S <= n.
Proof. induction n; simpl; [lia|]. destruct (S n); lia. Qed.

Lemma card_same (n : nat) (A B : set) : same n A B -> card n A = card n B.
Proof.
  induction n; simpl; intros E; [reflexivity|].
  rewrite (E n) by lia. rewrite IHn; [reflexivity|]. intros i Hi; apply E; lia.
Qed.

Lemma card_mono (n : nat) (A B : set) : subset n A B -> card n A <= card n B.
Proof.
  induction n; simpl; intros E; [lia|].
  assert (card n A <= card n B) by (apply IHn; intros i Hi; apply E; lia).
  specialize (E n ltac:(lia)). destruct (A n), (B n); lia.
Qed.

Lemma card_inclusion (n : nat) (A B : set) : card n (union A B) + card n (inter A B) = card n A + card n B.
Proof.
  induction n; simpl; [reflexivity|]. unfold union, inter in *. destruct (A n), (B n); simpl; lia.
Qed.

Lemma card_compl (n : nat) (A : set) : card n A + card n (compl A) = n.
Proof. induction n; simpl; [reflexivity|]. unfold compl in *. destruct (A n); simpl; lia. Qed.

(* Two sets together larger than n overlap by at least the excess. *)
Lemma card_overlap (n : nat) (A B : set) : card n A + card n B <= n + card n (inter A B).
Proof. pose proof (card_inclusion n A B). pose proof (card_le n (union A B)). lia. Qed.

Lemma card_zero (n : nat) (A : set) : card n A = 0 -> forall i, i < n -> A i = false.
Proof.
  induction n; simpl; intros E i Hi; [lia|].
  destruct (A n) eqn:An; [lia|].
  destruct (Nat.eq_dec i n) as [->|Ne]; [exact An|]. apply IHn; lia.
Qed.

Lemma card_pos (n : nat) (A : set) i : i < n -> A i = true -> 0 < card n A.
Proof.
  intros Hi Ai. destruct (card n A) eqn:E; [|lia]. rewrite (card_zero n A E i Hi) in Ai. discriminate.
Qed.

(* A subset of the same size is the same set. *)
Lemma subset_same (n : nat) (A B : set) : subset n A B -> card n B <= card n A -> same n A B.
Proof.
  induction n; intros E C i Hi; [lia|]. simpl in C.
  assert (subset n A B) as E' by (intros k Hk; apply E; lia).
  pose proof (card_mono n A B E').
  assert (A n = B n) as En.
  { specialize (E n ltac:(lia)). destruct (A n), (B n); try reflexivity; lia. }
  destruct (Nat.eq_dec i n) as [->|Ne]; [exact En|].
  apply IHn; [exact E'| |lia]. rewrite En in C. lia.
Qed.

Definition single (i : nat) : set := Nat.eqb i.
Definition add (i : nat) (A : set) : set := union (single i) A.

Lemma card_single (n i : nat) : i < n -> card n (single i) = 1.
Proof.
  induction n; intros Hi; [lia|]. simpl. unfold single at 2.
  destruct (Nat.eqb_spec i n) as [->|Ne].
  - assert (card n (single n) = 0) as ->; [|reflexivity].
    rewrite <- (Nat.sub_diag n). assert (forall k, k <= n -> card k (single n) = 0) as Z.
    { induction k; simpl; intros; [reflexivity|]. unfold single at 2.
      destruct (Nat.eqb_spec n k); [lia|]. rewrite IHk; lia. }
    rewrite Nat.sub_diag. now apply Z.
  - rewrite IHn by lia. lia.
Qed.

Lemma card_add (n i : nat) (A : set) : i < n -> A i = false -> card n (add i A) = Datatypes.S (card n A).
Proof.
  intros Hi Ai. unfold add. pose proof (card_inclusion n (single i) A). rewrite card_single in H by exact Hi.
  assert (card n (inter (single i) A) = 0); [|lia].
  transitivity (card n (fun _ => false)).
  - apply card_same. intros k _. unfold inter, single. destruct (Nat.eqb_spec i k) as [->|]; [now rewrite Ai|reflexivity].
  - clear. induction n; simpl; lia.
Qed.

(* Every size below that of a set is the size of one of its subsets. *)
Lemma subset_of_size (n : nat) (A : set) k : k <= card n A -> exists B, subset n B A /\ card n B = k.
Proof.
  revert k. induction n; intros k Hk; simpl in *.
  - exists A. split; [intros i Hi; lia|lia].
  - destruct (Nat.le_gt_cases k (card n A)) as [Le|Gt].
    + destruct (IHn k Le) as [B [BA Bk]]. exists (fun i => B i && Nat.ltb i n). split.
      * intros i Hi Bi. apply andb_prop in Bi as [Bi Lt]. apply Nat.ltb_lt in Lt. now apply BA.
      * simpl. rewrite Nat.ltb_irrefl, andb_false_r.
        rewrite (card_same n _ B); [lia|].
        intros i Hi. apply Nat.ltb_lt in Hi as ->. apply andb_true_r.
    + exists A. split; [intros i _ Ai; exact Ai|]. simpl. destruct (A n); lia.
Qed.

(* ... also when one member is to be kept. *)
Lemma subset_of_size_with (n : nat) (A : set) i k :
  i < n -> A i = true -> 1 <= k <= card n A -> exists B, subset n B A /\ card n B = k /\ B i = true.
Proof.
  intros Hi Ai [K1 K2]. set (R := fun j => A j && negb (Nat.eqb i j)).
  assert (card n (add i R) = Datatypes.S (card n R)) as C.
  { apply card_add; [exact Hi|]. unfold R. now rewrite Nat.eqb_refl, andb_false_r. }
  assert (card n (add i R) = card n A) as D.
  { apply card_same. intros j _. unfold add, union, single, R.
    destruct (Nat.eqb_spec i j) as [->|]; simpl; [now rewrite Ai|apply andb_true_r]. }
  destruct (subset_of_size n R (k - 1) ltac:(lia)) as [B [BR Bk]].
  exists (add i B). repeat split.
  - intros j Hj Bj. unfold add, union, single in Bj. destruct (Nat.eqb_spec i j) as [->|]; [exact Ai|].
    simpl in Bj. specialize (BR j Hj Bj). unfold R in BR. now apply andb_prop in BR.
  - rewrite card_add; [lia|exact Hi|]. destruct (B i) eqn:E; [|reflexivity].
    specialize (BR i Hi E). unfold R in BR. now rewrite Nat.eqb_refl, andb_false_r in BR.
  - unfold add, union, single. now rewrite Nat.eqb_refl.
Qed.

(* A set of three or more has three members in rising order. *)
Lemma three_members (n : nat) (A : set) :
  3 <= card n A -> exists i j k, i < j /\ j < k /\ k < n /\ A i = true /\ A j = true /\ A k = true.
Proof.
  assert (forall m B, 1 <= card m B -> exists i, i < m /\ B i = true) as One.
  { intros m B H. induction m; simpl in H; [lia|]. destruct (B m) eqn:E; [exists m; split; [lia|exact E]|].
    destruct IHm as [i [Hi Bi]]; [lia|]. exists i; split; [lia|exact Bi]. }
  assert (forall m B, 2 <= card m B -> exists i j, i < j /\ j < m /\ B i = true /\ B j = true) as Two.
  { intros m B H. induction m; simpl in H; [lia|]. destruct (B m) eqn:E.
    - destruct (One m B ltac:(lia)) as [i [Hi Bi]]. exists i, m. repeat split; try lia; assumption.
    - destruct IHm as [i [j [? [? ?]]]]; [lia|]. exists i, j. repeat split; try lia; tauto. }
  intros H. induction n; simpl in H; [lia|]. destruct (A n) eqn:E.
  - destruct (Two n A ltac:(lia)) as [i [j [? [? [? ?]]]]]. exists i, j, n. repeat split; try lia; assumption.
  - destruct IHn as [i [j [k [? [? [? ?]]]]]]; [lia|]. exists i, j, k. repeat split; try lia; tauto.
Qed.
