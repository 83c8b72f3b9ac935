(* The paper's estimate from three sensors (eqs 13, 17-20), and what noise and one fault do to it. *)
From Coq Require Import Reals Lra Psatz.
From Plumb Require Import Vectors Mirror.
Open Scope R_scope.

Definition estimate (a b c : vec) (ya yb yc : R) : vec :=
  vadd (scale ya (dual a b c)) (vadd (scale yb (dual b c a)) (scale yc (dual c a b))).

(* The order within the triple does not matter as far as it is rotated. *)
Lemma estimate_rotate a b c ya yb yc : estimate a b c ya yb yc = estimate b c a yb yc ya.
Proof. unfold estimate. vec_ring. Qed.

Lemma dual_swap (a b c : vec) : det a b c <> 0 -> dual a b c = dual a c b.
Proof.
  intros D. assert (det a c b = - det a b c) as E by (vec_unfold; ring).
  unfold dual. rewrite E. destruct a, b, c. unfold det in *. apply vec_eq; vec_unfold; field; lra.
Qed.

(* Readings = truth + disturbance: the estimate is truth + the same combination of the disturbances. *)
Lemma estimate_split a b c g da db dc :
  det a b c <> 0 -> estimate a b c (dot a g + da) (dot b g + db) (dot c g + dc) = vadd g (estimate a b c da db dc).
Proof. intros D. unfold estimate. rewrite (dual_expand a b c D g) at 4. vec_ring. Qed.

(* c(T): no disturbance of at most 1 per sensor moves the estimate by more. *)
Definition gain (a b c : vec) (k : R) : Prop :=
  forall s t u, Rabs s <= 1 -> Rabs t <= 1 -> Rabs u <= 1 -> norm (estimate a b c s t u) <= k.

(* It is enough to look at the eight corners +-1 of the cube: the squared length is convex in every coordinate. *)
Lemma convex_corner (p q r t m : R) :
  0 <= p -> Rabs t <= 1 -> p - q + r <= m -> p + q + r <= m -> p * t * t + q * t + r <= m.
Proof. intros P T A B. apply Rabs_le_inv in T as [T1 T2].
  assert (p * (t * t) <= p * 1) by (apply Rmult_le_compat_l; [exact P|nra]).
  assert (0 <= (1 + t) * (m - (p + q + r))) by (apply Rmult_le_pos; lra).
  assert (0 <= (1 - t) * (m - (p - q + r))) by (apply Rmult_le_pos; lra). lra.
Qed.

Theorem gain_from_corners (a b c : vec) (k : R) :
  0 <= k ->
  (forall s t u, (s = 1 \/ s = -1) -> (t = 1 \/ t = -1) -> (u = 1 \/ u = -1) -> norm2 (estimate a b c s t u) <= k * k) ->
  gain a b c k.
Proof.
  intros K Corner s t u Hs Ht Hu. apply norm_le; [exact K|]. unfold estimate in *.
  set (wa := dual a b c) in *. set (wb := dual b c a) in *. set (wc := dual c a b) in *.
  set (N := fun s t u => norm2 (vadd (scale s wa) (vadd (scale t wb) (scale u wc)))) in *.
  change (N s t u <= k * k). change (forall s t u, (s = 1 \/ s = -1) -> (t = 1 \/ t = -1) -> (u = 1 \/ u = -1) ->
    N s t u <= k * k) in Corner.
  assert (forall s t u, N s t u =
    norm2 wa * s * s + 2 * dot wa (vadd (scale t wb) (scale u wc)) * s + norm2 (vadd (scale t wb) (scale u wc))) as Ea
    by (intros; unfold N; vec_unfold; ring).
  assert (forall s t u, N s t u =
    norm2 wb * t * t + 2 * dot wb (vadd (scale s wa) (scale u wc)) * t + norm2 (vadd (scale s wa) (scale u wc))) as Eb
    by (intros; unfold N; vec_unfold; ring).
  assert (forall s t u, N s t u =
    norm2 wc * u * u + 2 * dot wc (vadd (scale s wa) (scale t wb)) * u + norm2 (vadd (scale s wa) (scale t wb))) as Ec
    by (intros; unfold N; vec_unfold; ring).
  assert (forall s t, (s = 1 \/ s = -1) -> (t = 1 \/ t = -1) -> N s t u <= k * k) as C1.
  { intros s' t' Hs' Ht'. rewrite Ec. apply convex_corner; [apply norm2_nonneg|exact Hu| |].
    - specialize (Corner s' t' (-1) Hs' Ht' (or_intror eq_refl)). rewrite Ec in Corner. lra.
    - specialize (Corner s' t' 1 Hs' Ht' (or_introl eq_refl)). rewrite Ec in Corner. lra. }
  assert (forall s, (s = 1 \/ s = -1) -> N s t u <= k * k) as C2.
  { intros s' Hs'. rewrite Eb. apply convex_corner; [apply norm2_nonneg|exact Ht| |].
    - specialize (C1 s' (-1) Hs' (or_intror eq_refl)). rewrite Eb in C1. lra.
    - specialize (C1 s' 1 Hs' (or_introl eq_refl)). rewrite Eb in C1. lra. }
  rewrite Ea. apply convex_corner; [apply norm2_nonneg|exact Hs| |].
  - specialize (C2 (-1) (or_intror eq_refl)). rewrite Ea in C2. lra.
  - specialize (C2 1 (or_introl eq_refl)). rewrite Ea in C2. lra.
Qed.

(* Noise of at most e per sensor moves the estimate by at most c(T) e. *)
Lemma noise_moves (a b c : vec) (k e ea eb ec : R) :
  gain a b c k -> Rabs ea <= e -> Rabs eb <= e -> Rabs ec <= e -> norm (estimate a b c ea eb ec) <= k * e.
Proof.
  intros Gain A B C. pose proof (Rabs_pos ea) as Pa.
  destruct (Req_dec e 0) as [Z|Nz].
  - assert (ea = 0) as -> by (apply Rabs_le_inv in A; lra).
    assert (eb = 0) as -> by (apply Rabs_le_inv in B; lra).
    assert (ec = 0) as -> by (apply Rabs_le_inv in C; lra).
    replace (estimate a b c 0 0 0) with (scale 0 vzero) by (unfold estimate; vec_ring).
    rewrite norm_scale, Rabs_R0, Z. lra.
  - assert (0 < e) as Pe by lra.
    replace (estimate a b c ea eb ec) with (scale e (estimate a b c (ea / e) (eb / e) (ec / e))).
    + rewrite norm_scale, Rabs_pos_eq by lra. rewrite Rmult_comm. apply Rmult_le_compat_r; [lra|].
      assert (forall r, Rabs r <= e -> Rabs (r / e) <= 1) as Unit.
      { intros r Hr. unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ e)).
        - apply (Rmult_le_reg_r e); [exact Pe|]. rewrite Rmult_assoc, Rinv_l; lra.
        - left. now apply Rinv_0_lt_compat. }
      apply Gain; now apply Unit.
    + unfold estimate. generalize (dual a b c) (dual b c a) (dual c a b). intros. apply vec_eq; vec_unfold; field; lra.
Qed.

Lemma gain_rotate a b c k : gain a b c k -> gain b c a k.
Proof. intros Gain s t u Hs Ht Hu. rewrite <- estimate_rotate. now apply Gain. Qed.

Lemma gain_nonneg a b c k : gain a b c k -> 0 <= k.
Proof.
  intros Gain. assert (Rabs 0 <= 1) as Z by (rewrite Rabs_R0; lra).
  pose proof (Gain 0 0 0 Z Z Z). pose proof (norm_nonneg (estimate a b c 0 0 0)). lra.
Qed.

(* A length within d of G has a square within 2 G d + d^2 of G^2. *)
Lemma square_close (x : vec) (G d : R) :
  0 <= G -> Rabs (norm x - G) <= d -> Rabs (norm2 x - G * G) <= 2 * G * d + d * d.
Proof.
  intros HG C. pose proof (norm_nonneg x). rewrite <- norm_sq. apply Rabs_le_inv in C as [C1 C2].
  set (u := norm x - G) in *. replace (norm x) with (G + u) by (unfold u; ring).
  assert (u * u <= d * d) by nra. assert (Rabs (G * u) <= G * d) as B.
  { rewrite Rabs_mult, (Rabs_pos_eq G) by exact HG. apply Rmult_le_compat_l; [exact HG|]. now apply Rabs_le. }
  apply Rabs_le_inv in B. apply Rabs_le. nra.
Qed.
