(* Vectors of R^3 as far as accelerometers need them, written out by components so that ring and nra decide. *)
From Coq Require Import Reals Lra Psatz.
Open Scope R_scope.

Lemma Rabs_le_inv (a b : R) : Rabs a <= b -> - b <= a <= b.
Proof. intros H. unfold Rabs in H. destruct (Rcase_abs a); lra. Qed.

Record vec := V { vx : R; vy : R; vz : R }.

Definition dot (a b : vec) : R := vx a * vx b + vy a * vy b + vz a * vz b.
Definition norm2 (a : vec) : R := dot a a.
Definition norm (a : vec) : R := sqrt (norm2 a).
Definition vadd (a b : vec) : vec := V (vx a + vx b) (vy a + vy b) (vz a + vz b).
Definition vsub (a b : vec) : vec := V (vx a - vx b) (vy a - vy b) (vz a - vz b).
Definition scale (s : R) (a : vec) : vec := V (s * vx a) (s * vy a) (s * vz a).
Definition cross (a b : vec) : vec :=
  V (vy a * vz b - vz a * vy b) (vz a * vx b - vx a * vz b) (vx a * vy b - vy a * vx b).
Definition det (a b c : vec) : R := dot a (cross b c).
Definition vzero : vec := V 0 0 0.

(* Column of the inverse of the matrix with rows a, b, c that belongs to a: its product is 1 with a, 0 with
   b and c. The paper's triple estimate is y_a w_a + y_b w_b + y_c w_c. *)
Definition dual (a b c : vec) : vec := scale (/ det a b c) (cross b c).

Ltac vec_unfold := unfold det, norm2, dot, cross, vadd, vsub, scale, vzero in *; simpl in *.

Lemma vec_eq (a b : vec) : vx a = vx b -> vy a = vy b -> vz a = vz b -> a = b.
Proof. destruct a, b; simpl; intros; subst; reflexivity. Qed.

Ltac vec_ring := apply vec_eq; vec_unfold; try ring.

Lemma dot_sub_r (h a b : vec) : dot h (vsub a b) = dot h a - dot h b.
Proof. vec_unfold; ring. Qed.
Lemma dot_add_r (h a b : vec) : dot h (vadd a b) = dot h a + dot h b.
Proof. vec_unfold; ring. Qed.
Lemma dot_scale_r (h : vec) (s : R) (a : vec) : dot h (scale s a) = s * dot h a.
Proof. vec_unfold; ring. Qed.
Lemma dot_comm (a b : vec) : dot a b = dot b a.
Proof. vec_unfold; ring. Qed.

Lemma norm2_nonneg (a : vec) : 0 <= norm2 a.
Proof. vec_unfold; nra. Qed.

Lemma norm2_zero (a : vec) : norm2 a = 0 -> a = vzero.
Proof. intros H; apply vec_eq; vec_unfold; nra. Qed.

Lemma norm2_pos (a : vec) : a <> vzero -> 0 < norm2 a.
Proof.
  intros Ne. destruct (Rle_lt_or_eq_dec 0 (norm2 a) (norm2_nonneg a)) as [L|E]; [exact L|].
  exfalso. apply Ne, norm2_zero. now symmetry.
Qed.

Lemma norm_nonneg (a : vec) : 0 <= norm a.
Proof. apply sqrt_pos. Qed.

Lemma norm_sq (a : vec) : norm a * norm a = norm2 a.
Proof. apply sqrt_sqrt, norm2_nonneg. Qed.

Lemma norm_le (a : vec) (r : R) : 0 <= r -> norm2 a <= r * r -> norm a <= r.
Proof. intros Hr H. unfold norm. rewrite <- (sqrt_square r Hr). now apply sqrt_le_1_alt. Qed.

Lemma norm2_le (a : vec) (r : R) : norm a <= r -> norm2 a <= r * r.
Proof. intros H. rewrite <- norm_sq. pose proof (norm_nonneg a). nra. Qed.

Lemma cauchy_schwarz (a b : vec) : dot a b <= norm a * norm b.
Proof.
  pose proof (norm_nonneg a) as Na. pose proof (norm_nonneg b) as Nb.
  assert (dot a b * dot a b <= norm2 a * norm2 b) as Q.
  { vec_unfold. destruct a as [a1 a2 a3], b as [b1 b2 b3]; simpl.
    pose proof (Rle_0_sqr (a1 * b2 - a2 * b1)). pose proof (Rle_0_sqr (a1 * b3 - a3 * b1)).
    pose proof (Rle_0_sqr (a2 * b3 - a3 * b2)). unfold Rsqr in *. nra. }
  rewrite <- !norm_sq in Q. destruct (Rle_lt_dec (dot a b) 0) as [L|G]; [nra|].
  apply Rnot_lt_le. intros C. pose proof (Rmult_le_pos _ _ Na Nb) as P.
  replace (norm a * norm a * (norm b * norm b)) with (norm a * norm b * (norm a * norm b)) in Q by ring. nra.
Qed.

Lemma norm_triangle (a b : vec) : norm (vadd a b) <= norm a + norm b.
Proof.
  pose proof (norm_nonneg a). pose proof (norm_nonneg b).
  apply norm_le; [lra|].
  replace (norm2 (vadd a b)) with (norm2 a + 2 * dot a b + norm2 b) by (vec_unfold; ring).
  rewrite <- !norm_sq. pose proof (cauchy_schwarz a b). nra.
Qed.

(* Adding d changes the length by at most the length of d. *)
Lemma norm_add_close (a d : vec) : Rabs (norm (vadd a d) - norm a) <= norm d.
Proof.
  pose proof (norm_triangle a d) as U.
  pose proof (norm_triangle (vadd a d) (scale (-1) d)) as L.
  replace (vadd (vadd a d) (scale (-1) d)) with a in L by vec_ring.
  replace (norm (scale (-1) d)) with (norm d) in L by (unfold norm; f_equal; vec_unfold; ring).
  apply Rabs_le. lra.
Qed.

Lemma norm_scale (s : R) (a : vec) : norm (scale s a) = Rabs s * norm a.
Proof.
  unfold norm. replace (norm2 (scale s a)) with (Rsqr s * norm2 a) by (unfold Rsqr; vec_unfold; ring).
  rewrite sqrt_mult_alt by apply Rle_0_sqr. now rewrite sqrt_Rsqr_abs.
Qed.

Section Dual.
  Variables a b c : vec.
  Hypothesis independent : det a b c <> 0.

  Lemma dual_self : dot a (dual a b c) = 1.
  Proof. unfold dual. rewrite dot_scale_r. fold (det a b c). now field. Qed.
  Lemma dual_second : dot b (dual a b c) = 0.
  Proof. unfold dual. rewrite dot_scale_r. vec_unfold; ring. Qed.
  Lemma dual_third : dot c (dual a b c) = 0.
  Proof. unfold dual. rewrite dot_scale_r. vec_unfold; ring. Qed.
  Lemma dual_pos : 0 < norm2 (dual a b c).
  Proof.
    apply norm2_pos. intros E. pose proof dual_self as D. rewrite E in D. vec_unfold. lra.
  Qed.

  (* The dual vectors rebuild every vector from its three readings. *)
  Lemma dual_expand (x : vec) :
    x = vadd (scale (dot a x) (dual a b c)) (vadd (scale (dot b x) (dual b c a)) (scale (dot c x) (dual c a b))).
  Proof.
    assert (det b c a = det a b c) as D1 by (vec_unfold; ring).
    assert (det c a b = det a b c) as D2 by (vec_unfold; ring).
    unfold dual. rewrite D1, D2. destruct a, b, c, x. unfold det in *.
    apply vec_eq; vec_unfold; field; exact independent.
  Qed.
End Dual.

Lemma det_rotate (a b c : vec) : det b c a = det a b c.
Proof. vec_unfold; ring. Qed.

(* Three independent axes determine the vector. *)
Lemma three_axes_determine (a b c x x' : vec) :
  det a b c <> 0 -> dot a x = dot a x' -> dot b x = dot b x' -> dot c x = dot c x' -> x = x'.
Proof.
  intros D A B C. rewrite (dual_expand a b c D x), (dual_expand a b c D x'). now rewrite A, B, C.
Qed.

(* A vector orthogonal to three independent axes is zero; contraposed: axes in one plane have determinant 0. *)
Lemma in_plane_det (a b c v : vec) : v <> vzero -> dot a v = 0 -> dot b v = 0 -> dot c v = 0 -> det a b c = 0.
Proof.
  intros Ne A B C. destruct (Req_dec (det a b c) 0) as [E|N]; [exact E|]. exfalso. apply Ne.
  apply (three_axes_determine a b c); [exact N|rewrite A|rewrite B|rewrite C]; vec_unfold; ring.
Qed.
