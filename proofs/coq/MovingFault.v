(* Why T5 says "healthy throughout": four sensors, two stations, never more than one fault at a time - and the strict
   rule accuses a sensor that was never faulty. A fault that moves counts as two; the sensors healthy throughout are only
   two here (rank 2). All numbers are exact. Sensors are counted from 0. *)
From Coq Require Import Reals Lra Arith Bool Lia List.
From Plumb Require Import Sets Vectors Sensors Soundness.
Open Scope R_scope.

Definition axis (i : nat) : vec :=
  match i with 0%nat => V 2 1 3 | 1%nat => V (-2) 2 (-1) | 2%nat => V 0 2 0 | _ => V 1 (-3) (-3) end.
Definition gravity (k : nat) : vec := match k with O => V (-4) (-2) 1 | _ => V 3 (-5) 5 end.
(* At station 0 sensor 0 is off by 702/73, at station 1 sensor 1 by 806/83; each is the mirror fault of the triple 0, 1, 3. *)
Definition offset (k i : nat) : R :=
  match k, i with 0%nat, 0%nat => 702 / 73 | 1%nat, 1%nat => 806 / 83 | _, _ => 0 end.
Definition reading (k i : nat) : R := dot (axis i) (gravity k) + offset k i.

(* Alive over the episode: at each station some vector of gravity's length explains the set. *)
Definition survives (S : set) : Prop :=
  forall k, (k < 2)%nat -> exists x, norm2 x = norm2 (gravity k) /\ explains 4 axis x S (reading k).

Lemma survives_hereditary A B : survives A -> subset 4 B A -> survives B.
Proof.
  intros Al Sub k Hk. destruct (Al k Hk) as [x [L E]]. exists x. split; [exact L|].
  intros i Hi Bi. apply E; [exact Hi|]. now apply Sub.
Qed.

Theorem moving_fault_one_at_a_time :
  forall k, (k < 2)%nat -> exists i, forall j, (j < 4)%nat -> j <> i -> offset k j = 0.
Proof.
  intros k Hk. exists k. intros j Hj Ne. destruct k as [|[|k]]; [| |lia]; destruct j as [|[|j]]; try reflexivity; lia.
Qed.

Theorem moving_fault_general_position : general_position 4 axis.
Proof.
  intros i j k Hij Hjk Hk.
  assert ((i = 0 /\ j = 1 /\ k = 2) \/ (i = 0 /\ j = 1 /\ k = 3) \/ (i = 0 /\ j = 2 /\ k = 3) \/
          (i = 1 /\ j = 2 /\ k = 3))%nat as Cases by lia.
  destruct Cases as [[-> [-> ->]]|[[-> [-> ->]]|[[-> [-> ->]]|[-> [-> ->]]]]]; unfold axis; vec_unfold; lra.
Qed.

Definition trio (a b c : nat) : set := fun i => Nat.eqb i a || Nat.eqb i b || Nat.eqb i c.

Lemma wrong_trio_alive : survives (trio 0 1 3).
Proof.
  intros k Hk. destruct k as [|[|k]]; [| |lia].
  - exists (V (194 / 73) (232 / 73) (-143 / 73)). split; [unfold gravity; vec_unfold; lra|].
    intros i Hi Si. unfold reading. destruct i as [|[|[|[|i]]]]; try discriminate Si; try lia;
      unfold axis, gravity, offset; vec_unfold; lra.
  - exists (V (621 / 83) (143 / 83) (-19 / 83)). split; [unfold gravity; vec_unfold; lra|].
    intros i Hi Si. unfold reading. destruct i as [|[|[|[|i]]]]; try discriminate Si; try lia;
      unfold axis, gravity, offset; vec_unfold; lra.
Qed.

(* A trio pins the vector; its length then differs from gravity's. *)
Ltac dead_at k a b c x y z :=
  intros Al; destruct (Al k ltac:(lia)) as [[x0 y0 z0] [L E]];
  pose proof (E a ltac:(lia) eq_refl) as Ea; pose proof (E b ltac:(lia) eq_refl) as Eb;
  pose proof (E c ltac:(lia) eq_refl) as Ec;
  unfold reading, axis, gravity, offset in *; vec_unfold;
  assert (x0 = x) by lra; assert (y0 = y) by lra; assert (z0 = z) by lra; subst; lra.

Lemma dead_012 : ~ survives (trio 0 1 2).
Proof. dead_at 0%nat 0%nat 1%nat 2%nat (-935 / 146) (-2) (424 / 73). Qed.
Lemma dead_023 : ~ survives (trio 0 2 3).
Proof. dead_at 0%nat 0%nat 2%nat 3%nat (-58 / 73) (-2) (151 / 73). Qed.
Lemma dead_123 : ~ survives (trio 1 2 3).
Proof. dead_at 1%nat 1%nat 2%nat 3%nat (-675 / 581) (-5) (2099 / 581). Qed.

(* The counter-example: sensor 2 is healthy at both stations and yet accused at the strict grade n - 3 = 1. *)
Theorem moving_fault_blames_the_healthy :
  (forall k, (k < 2)%nat -> offset k 2 = 0) /\ accused 4 survives 1 2.
Proof.
  split; [intros [|[|k]] Hk; reflexivity|].
  apply (strict_grade_by_voting_sets 4 survives 2 2); try lia; [exact survives_hereditary|].
  intros S A K. destruct (S 2%nat) eqn:S2; [|reflexivity]. exfalso.
  simpl in K. rewrite S2 in K.
  assert (forall T, (forall i, (i < 4)%nat -> T i = true -> S i = true) -> survives T) as Sub.
  { intros T HT. now apply (survives_hereditary S T A). }
  destruct (S 0%nat) eqn:S0, (S 1%nat) eqn:S1, (S 3%nat) eqn:S3; simpl in K; try lia;
    [apply dead_012|apply dead_023|apply dead_123]; apply Sub;
    intros [|[|[|[|i]]]] Hi Ti; try lia; try assumption; discriminate Ti.
Qed.

(* What the condition of T5 would have asked for: at most one sensor not healthy throughout. Here there are two. *)
Theorem moving_fault_counts_as_two (S0 : set) :
  (forall i, (i < 4)%nat -> S0 i = true -> forall k, (k < 2)%nat -> offset k i = 0) ->
  (2 <= card 4 (compl S0))%nat.
Proof.
  intros H. unfold compl. simpl.
  destruct (S0 0%nat) eqn:S0'; [specialize (H 0%nat ltac:(lia) S0' 0%nat ltac:(lia)); unfold offset in H; lra|].
  destruct (S0 1%nat) eqn:S1'; [specialize (H 1%nat ltac:(lia) S1' 1%nat ltac:(lia)); unfold offset in H; lra|].
  simpl. lia.
Qed.

(* The condition itself: "at every station at most one sensor is faulty" instead of "at most one is not healthy throughout"
   would not make the rule sound, not even for axes in general position and without noise. *)
Definition explained_throughout (n : nat) (h g : nat -> vec) (f : nat -> nat -> R) (stations : nat) (S : set) : Prop :=
  forall k, (k < stations)%nat -> exists x, norm2 x = norm2 (g k) /\ explains n h x S (readings h (g k) (f k)).
Definition sound_if_one_at_a_time : Prop :=
  forall (n : nat) (h g : nat -> vec) (f : nat -> nat -> R) (stations : nat),
  general_position n h ->
  (forall k, (k < stations)%nat -> exists i, forall j, (j < n)%nat -> j <> i -> f k j = 0) ->
  forall i, (i < n)%nat -> (forall k, (k < stations)%nat -> f k i = 0) ->
  ~ accused n (explained_throughout n h g f stations) (n - 3) i.

Theorem moving_fault_refutes_one_at_a_time : ~ sound_if_one_at_a_time.
Proof.
  intros Sound. destruct moving_fault_blames_the_healthy as [Healthy Blamed].
  exact (Sound 4%nat axis gravity offset 2%nat moving_fault_general_position moving_fault_one_at_a_time
           2%nat ltac:(lia) Healthy Blamed).
Qed.

(* With the condition of T5 the same rule is sound: who is healthy throughout is not accused while at most n - 3 are not. *)
Theorem healthy_throughout_is_enough (n : nat) (h g : nat -> vec) (f : nat -> nat -> R) (stations : nat) (S0 : set) :
  (forall k i, (k < stations)%nat -> (i < n)%nat -> S0 i = true -> f k i = 0) ->
  (card n (compl S0) <= n - 3)%nat ->
  forall i, S0 i = true -> ~ accused n (explained_throughout n h g f stations) (n - 3) i.
Proof.
  intros Healthy Few. apply T5_never_the_healthy; [|exact Few].
  intros k Hk. exists (g k). split; [reflexivity|]. intros i Hi Si. unfold readings. rewrite Healthy by assumption. ring.
Qed.
