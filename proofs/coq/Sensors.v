(* An array of single-axis sensors and what "in one plane" means. Readings are y_i = h_i.g + f_i without noise; the
   faulty sensors are those with f_i <> 0. *)
From Coq Require Import Reals Lra Arith Bool Lia.
From Plumb Require Import Sets Vectors.
Open Scope R_scope.

Section Array.
  Variable n : nat.           (* number of sensors *)
  Variable h : nat -> vec.    (* their axes *)

  (* No plane holds more than c axes: a normal v <> 0 is orthogonal to at most c of them. *)
  Definition at_most_coplanar (c : nat) : Prop :=
    forall (v : vec) (S : set), v <> vzero -> (forall i, (i < n)%nat -> S i = true -> dot (h i) v = 0) ->
    (card n S <= c)%nat.

  (* ... and some plane holds exactly c: c is the coplanarity number of the array. [C] lists all axes of that plane. *)
  Definition coplanarity (c : nat) : Prop :=
    at_most_coplanar c /\
    exists (v : vec) (C : set), v <> vzero /\ card n C = c /\
      forall i, (i < n)%nat -> (C i = true <-> dot (h i) v = 0).

  (* General position: every three axes are independent. *)
  Definition general_position : Prop :=
    forall i j k, (i < j)%nat -> (j < k)%nat -> (k < n)%nat -> det (h i) (h j) (h k) <> 0.

  Lemma general_position_coplanar : general_position -> at_most_coplanar 2.
  Proof.
    intros GP v S Ne In. destruct (le_lt_dec (card n S) 2) as [L|G]; [exact L|].
    destruct (three_members n S G) as [i [j [k [Hij [Hjk [Hk [Si [Sj Sk]]]]]]]].
    exfalso. apply (GP i j k Hij Hjk Hk).
    apply (in_plane_det _ _ _ v Ne); apply In; try assumption; lia.
  Qed.

  (* A set S of sensors is consistent with the readings y if one vector explains all of it ... *)
  Definition explains (x : vec) (S : set) (y : nat -> R) : Prop :=
    forall i, (i < n)%nat -> S i = true -> dot (h i) x = y i.
  Definition consistent (S : set) (y : nat -> R) : Prop := exists x, explains x S y.
  (* ... and alive if that vector has the length of gravity G as well. *)
  Definition alive (G : R) (S : set) (y : nat -> R) : Prop := exists x, norm2 x = G * G /\ explains x S y.

  Lemma alive_consistent G S y : alive G S y -> consistent S y.
  Proof. intros [x [_ E]]. now exists x. Qed.

  Definition readings (g : vec) (f : nat -> R) : nat -> R := fun i => dot (h i) g + f i.

  (* The healthy sensors, given as a set S0 with a proof that it is the right one. *)
  Definition healthy (S0 : set) (f : nat -> R) : Prop := forall i, (i < n)%nat -> (S0 i = true <-> f i = 0).

  (* Two vectors that agree on more than c sensors are the same. *)
  Lemma agree_equal c (x x' : vec) (S : set) :
    at_most_coplanar c -> (c < card n S)%nat ->
    (forall i, (i < n)%nat -> S i = true -> dot (h i) x = dot (h i) x') -> x = x'.
  Proof.
    intros Cop Big Eq.
    destruct (Req_dec (norm2 (vsub x x')) 0) as [Z|N].
    - apply norm2_zero in Z. apply vec_eq;
        [apply (f_equal vx) in Z|apply (f_equal vy) in Z|apply (f_equal vz) in Z]; simpl in Z; lra.
    - exfalso. assert (card n S <= c)%nat; [|lia].
      apply (Cop (vsub x x')).
      + intros E. apply N. rewrite E. vec_unfold. ring.
      + intros i Hi Si. rewrite dot_sub_r, (Eq i Hi Si). lra.
  Qed.
End Array.
