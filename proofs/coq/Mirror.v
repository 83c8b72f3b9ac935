(* T1, the mirror: what one fault does to the length that a triple estimates. A fault f on sensor a of the triple
   (a, b, c) moves the estimate by f w, w = dual a b c. *)
From Coq Require Import Reals Lra Psatz.
From Plumb Require Import Vectors.
Open Scope R_scope.

(* The one fault value, other than none, that keeps the length. *)
Definition mirror_fault (g w : vec) : R := - (2 * dot g w) / norm2 w.

(* T1: the squared length is off by |w|^2 f (f - f_mirror). *)
Theorem T1_mirror_identity (g w : vec) (f : R) :
  0 < norm2 w -> norm2 (vadd g (scale f w)) - norm2 g = norm2 w * f * (f - mirror_fault g w).
Proof.
  intros Hw. unfold mirror_fault.
  replace (norm2 (vadd g (scale f w)) - norm2 g) with (norm2 w * f * f + 2 * dot g w * f) by (vec_unfold; ring).
  field. lra.
Qed.

(* T1, uniqueness: the length is kept by no fault, by the mirror fault, and by no other. *)
Theorem T1_mirror_unique (g w : vec) (f : R) :
  0 < norm2 w -> (norm2 (vadd g (scale f w)) = norm2 g <-> f = 0 \/ f = mirror_fault g w).
Proof.
  intros Hw. pose proof (T1_mirror_identity g w f Hw) as I. split.
  - intros E. assert (f * (f - mirror_fault g w) = 0) as Z.
    { apply (Rmult_eq_reg_l (norm2 w)); [|lra]. lra. }
    apply Rmult_integral in Z. destruct Z; [left|right]; lra.
  - intros [->| ->]; [|revert I]; intros; nra.
Qed.

(* T1, why "mirror": the wrong estimate is g reflected in the plane of the two healthy axes. It agrees with g on both,
   g + x lies in their plane (is orthogonal to the plane's normal w), g - x is along that normal. *)
Theorem T1_mirror_is_reflection (a b c g : vec) :
  det a b c <> 0 ->
  let w := dual a b c in
  let x := vadd g (scale (mirror_fault g w) w) in
  dot b x = dot b g /\ dot c x = dot c g /\ dot (vadd g x) w = 0 /\ norm2 x = norm2 g.
Proof.
  intros D w x. assert (0 < norm2 w) as P by now apply dual_pos. repeat split.
  - unfold x. rewrite dot_add_r, dot_scale_r. unfold w at 2. rewrite dual_second by exact D. ring.
  - unfold x. rewrite dot_add_r, dot_scale_r. unfold w at 2. rewrite dual_third by exact D. ring.
  - replace (dot (vadd g x) w) with (2 * dot g w + mirror_fault g w * norm2 w) by (unfold x; vec_unfold; ring).
    unfold mirror_fault. field. lra.
  - apply T1_mirror_unique; [exact P|]. now right.
Qed.

(* T1 for real readings: the triple's estimate from g's readings with f added on the first sensor is g + f w. *)
Theorem T1_estimate_of_triple (a b c g : vec) (f : R) :
  det a b c <> 0 ->
  vadd (scale (dot a g + f) (dual a b c)) (vadd (scale (dot b g) (dual b c a)) (scale (dot c g) (dual c a b)))
  = vadd g (scale f (dual a b c)).
Proof.
  intros D. rewrite (dual_expand a b c D g) at 4. vec_ring.
Qed.

(* The paper's four axes (eq 16) and their dual vectors, exactly: |w|^2 = 3/2, mirror fault -(4/3) g.w. *)
Section Tetrahedron.
  Definition tetra1 := V (2 / 3 * sqrt 2) 0 (1 / 3).
  Definition tetra2 := V (- (1 / 3) * sqrt 2) (1 / 3 * sqrt 6) (1 / 3).
  Definition tetra3 := V (- (1 / 3) * sqrt 2) (- (1 / 3) * sqrt 6) (1 / 3).
  Definition tetra4 := V 0 0 1.

  Lemma r2_sq : sqrt 2 * sqrt 2 = 2. Proof. apply sqrt_sqrt; lra. Qed.
  Lemma r6_sq : sqrt 6 * sqrt 6 = 6. Proof. apply sqrt_sqrt; lra. Qed.
  Lemma r2_pos : 0 < sqrt 2. Proof. apply sqrt_lt_R0; lra. Qed.
  Lemma r6_pos : 0 < sqrt 6. Proof. apply sqrt_lt_R0; lra. Qed.

  Theorem tetrahedron_dual_124 : dual tetra1 tetra2 tetra4 = V (3 / 4 * sqrt 2) (1 / 4 * sqrt 6) 0.
  Proof.
    pose proof r2_sq. pose proof r6_sq. pose proof r2_pos. pose proof r6_pos.
    assert (det tetra1 tetra2 tetra4 = 2 / 9 * (sqrt 2 * sqrt 6)) as D.
    { unfold tetra1, tetra2, tetra4. vec_unfold. field. }
    unfold dual. rewrite D. unfold tetra1, tetra2, tetra4. apply vec_eq; vec_unfold.
    - replace (/ (2 / 9 * (sqrt 2 * sqrt 6)) * (1 / 3 * sqrt 6 * 1 - 1 / 3 * 0)) with (3 / 2 / sqrt 2)
        by (field; lra).
      apply (Rmult_eq_reg_r (sqrt 2)); [|lra]. field_simplify; [nra|lra].
    - replace (/ (2 / 9 * (sqrt 2 * sqrt 6)) * (1 / 3 * 0 - - (1 / 3) * sqrt 2 * 1)) with (3 / 2 / sqrt 6)
        by (field; lra).
      apply (Rmult_eq_reg_r (sqrt 6)); [|lra]. field_simplify; [nra|lra].
    - field. lra.
  Qed.

  Theorem tetrahedron_mirror (g : vec) :
    let w := dual tetra1 tetra2 tetra4 in norm2 w = 3 / 2 /\ mirror_fault g w = - (4 / 3) * dot g w.
  Proof.
    intros w. assert (norm2 w = 3 / 2) as N.
    { unfold w. rewrite tetrahedron_dual_124. pose proof r2_sq. pose proof r6_sq. vec_unfold. nra. }
    split; [exact N|]. unfold mirror_fault. rewrite N. field.
  Qed.
End Tetrahedron.
