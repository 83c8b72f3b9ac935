(* T8: one fault, one attitude, noise and residual calibration error of each sensor within e. A triple passes if the length
   of its estimate is within delta of gravity's. [k] bounds c(T) of every triple. *)
From Coq Require Import Reals Lra Arith Lia Psatz.
From Plumb Require Import Vectors Mirror Triples.
Open Scope R_scope.

Section OneAttitude.
  Variable n : nat.
  Variable h : nat -> vec.
  Variables (g : vec) (delta e k : R).
  Variable eps : nat -> R.
  Variables (i : nat) (f : R).     (* the faulty sensor and its fault *)

  Let G := norm g.
  Let reach := delta + k * e.      (* delta' of the notes *)

  Definition distinct (p q r : nat) : Prop := (p < n /\ q < n /\ r < n /\ p <> q /\ q <> r /\ p <> r)%nat.

  Hypothesis independent : forall p q r, distinct p q r -> det (h p) (h q) (h r) <> 0.
  Hypothesis gains : forall p q r, distinct p q r -> gain (h p) (h q) (h r) k.
  Hypothesis noise : forall p, (p < n)%nat -> Rabs (eps p) <= e.
  Hypothesis tolerance : k * e <= delta.

  Definition reading (p : nat) : R := dot (h p) g + ((if Nat.eqb p i then f else 0) + eps p).
  Definition passes (p q r : nat) : Prop :=
    Rabs (norm (estimate (h p) (h q) (h r) (reading p) (reading q) (reading r)) - G) <= delta.

  Lemma passes_rotate p q r : passes p q r <-> passes q r p.
  Proof. unfold passes. now rewrite estimate_rotate. Qed.
  Lemma distinct_rotate p q r : distinct p q r -> distinct q r p.
  Proof. unfold distinct. lia. Qed.

  (* A triple without the faulty sensor passes. *)
  Lemma healthy_triple_passes p q r : distinct p q r -> p <> i -> q <> i -> r <> i -> passes p q r.
  Proof.
    intros D P Q R. unfold passes, reading.
    apply Nat.eqb_neq in P as ->. apply Nat.eqb_neq in Q as ->. apply Nat.eqb_neq in R as ->.
    rewrite !Rplus_0_l, estimate_split by now apply independent.
    apply Rle_trans with (2 := tolerance).
    apply Rle_trans with (1 := norm_add_close _ _).
    pose proof D as [? [? [? _]]]. apply noise_moves; try (apply noise; assumption). now apply gains.
  Qed.

  (* The fault has to stay clear of both lengths that the triple cannot tell apart: no fault and the mirror. *)
  Definition clear_of_mirror (w : vec) : Prop :=
    norm2 w * (Rabs f * Rabs (f - mirror_fault g w)) > 2 * G * reach + reach * reach.

  Lemma faulty_triple_fails q r :
    distinct i q r -> clear_of_mirror (dual (h i) (h q) (h r)) -> ~ passes i q r.
  Proof.
    intros D Clear Pass. unfold passes, reading in Pass. rewrite Nat.eqb_refl in Pass.
    pose proof D as [Hi [Hq [Hr [Nq [_ Nr]]]]].
    assert (Nat.eqb q i = false) as Eq by (apply Nat.eqb_neq; lia).
    assert (Nat.eqb r i = false) as Er by (apply Nat.eqb_neq; lia).
    rewrite Eq, Er, estimate_split, !Rplus_0_l in Pass by now apply independent.
    set (w := dual (h i) (h q) (h r)) in *.
    assert (estimate (h i) (h q) (h r) (f + eps i) (eps q) (eps r)
            = vadd (scale f w) (estimate (h i) (h q) (h r) (eps i) (eps q) (eps r))) as Split
      by (unfold estimate; fold w; vec_ring).
    rewrite Split in Pass. set (noise_part := estimate (h i) (h q) (h r) (eps i) (eps q) (eps r)) in *.
    replace (vadd g (vadd (scale f w) noise_part)) with (vadd (vadd g (scale f w)) noise_part) in Pass by vec_ring.
    pose proof (norm_add_close (vadd g (scale f w)) noise_part) as Close.
    assert (norm noise_part <= k * e) as Small.
    { apply noise_moves; try (apply noise; lia). now apply gains. }
    assert (Rabs (norm (vadd g (scale f w)) - G) <= reach) as Near.
    { unfold reach. apply Rabs_le_inv in Pass. apply Rabs_le_inv in Close. apply Rabs_le. lra. }
    apply square_close in Near; [|apply norm_nonneg].
    unfold G in Near at 1 2. rewrite norm_sq in Near.
    assert (0 < norm2 w) as Pw by now apply dual_pos, independent.
    rewrite T1_mirror_identity, !Rabs_mult, (Rabs_pos_eq (norm2 w)) in Near by lra.
    unfold clear_of_mirror in Clear. rewrite Rmult_assoc in Near. fold G in Near. lra.
  Qed.

  (* T8: the passing triples are exactly those without the faulty sensor. *)
  Theorem T8_one_attitude :
    (forall q r, distinct i q r -> clear_of_mirror (dual (h i) (h q) (h r))) ->
    forall p q r, distinct p q r -> (passes p q r <-> p <> i /\ q <> i /\ r <> i).
  Proof.
    intros Clear p q r D. split.
    - intros Pass. repeat split; intros ->.
      + revert Pass. apply faulty_triple_fails; [exact D|now apply Clear].
      + apply (proj1 (passes_rotate p i r)) in Pass. apply distinct_rotate in D.
        revert Pass. apply faulty_triple_fails; [exact D|now apply Clear].
      + apply (proj1 (passes_rotate p q i)), (proj1 (passes_rotate q i p)) in Pass.
        apply distinct_rotate, distinct_rotate in D.
        revert Pass. apply faulty_triple_fails; [exact D|now apply Clear].
    - intros [P [Q R]]. now apply healthy_triple_passes.
  Qed.

  (* T8, whatever the attitude: a fault this large is clear of every mirror. *)
  Theorem T8_attitude_free (w : vec) :
    0 < norm w -> 0 <= reach -> Rabs f * norm w > 2 * G + reach -> clear_of_mirror w.
  Proof.
    intros Pw Pr Large. unfold clear_of_mirror. assert (0 <= G) by apply norm_nonneg.
    assert (Rabs (mirror_fault g w) * norm w <= 2 * G) as M.
    { unfold mirror_fault. rewrite <- norm_sq. unfold Rdiv.
      rewrite Rabs_mult, Rabs_Ropp, Rabs_mult, (Rabs_pos_eq 2) by lra.
      rewrite (Rabs_pos_eq (/ _)) by (left; apply Rinv_0_lt_compat; nra).
      assert (Rabs (dot g w) <= G * norm w) as CS.
      { apply Rabs_le. split; [|apply cauchy_schwarz].
        pose proof (cauchy_schwarz (scale (-1) g) w) as L. rewrite norm_scale in L.
        replace (Rabs (-1)) with 1 in L by (rewrite Rabs_left; lra).
        rewrite dot_comm, dot_scale_r, dot_comm in L. unfold G. lra. }
      apply Rle_trans with (2 * (G * norm w) * / (norm w * norm w) * norm w).
      - apply Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat; nra|]. lra.
      - right. field. lra. }
    rewrite <- norm_sq.
    assert (Rabs (f - mirror_fault g w) * norm w > reach) as Far.
    { pose proof (Rabs_triang_inv f (mirror_fault g w)). nra. }
    pose proof (Rabs_pos f). pose proof (Rabs_pos (f - mirror_fault g w)).
    replace (norm w * norm w * (Rabs f * Rabs (f - mirror_fault g w)))
      with (Rabs f * norm w * (Rabs (f - mirror_fault g w) * norm w)) by ring.
    apply Rlt_gt. apply Rle_lt_trans with ((2 * G + reach) * reach); [right; ring|].
    apply Rle_lt_trans with ((Rabs f * norm w) * reach); [apply Rmult_le_compat_r; lra|].
    apply Rmult_lt_compat_l; [|lra]. lra.
  Qed.
End OneAttitude.

(* T8 for the paper's case, four sensors: dropping sensor d leaves a triple that passes if and only if d is the faulty one. *)
Definition others (d : nat) : nat * nat * nat :=
  match d with 0 => (1, 2, 3) | 1 => (2, 3, 0) | 2 => (3, 0, 1) | _ => (0, 1, 2) end%nat.

Theorem T8_four_sensors (h : nat -> vec) (g : vec) (delta e k f : R) (eps : nat -> R) (i : nat) :
  (i < 4)%nat ->
  (forall p q r, distinct 4 p q r -> det (h p) (h q) (h r) <> 0) ->
  (forall p q r, distinct 4 p q r -> gain (h p) (h q) (h r) k) ->
  (forall p, (p < 4)%nat -> Rabs (eps p) <= e) -> k * e <= delta ->
  (forall q r, distinct 4 i q r -> clear_of_mirror g delta e k f (dual (h i) (h q) (h r))) ->
  forall d, (d < 4)%nat ->
  ((let '(p, q, r) := others d in passes h g delta eps i f p q r) <-> d = i).
Proof.
  intros Hi Ind Gain Noise Tol Clear d Hd.
  assert (let '(p, q, r) := others d in distinct 4 p q r /\ (p <> i /\ q <> i /\ r <> i <-> d = i)) as Case.
  { destruct d as [|[|[|[|d]]]]; simpl; unfold distinct; lia. }
  destruct (others d) as [[p q] r]. destruct Case as [D W]. rewrite <- W.
  now apply (T8_one_attitude 4 h g delta e k eps i f).
Qed.
