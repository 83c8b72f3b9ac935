(* T9: a constant fault cannot hide from a triple while the attitude changes. T10: what the length alone can never see. *)
From Coq Require Import Reals Lra Arith Lia Psatz.
From Plumb Require Import Vectors Mirror Triples.
Open Scope R_scope.

Definition mean (v : nat -> R) (N : nat) : R := sum_f_R0 v N / INR (S N).    (* of v 0 .. v N *)

Lemma mean_le u v N : (forall k, (k <= N)%nat -> u k <= v k) -> mean u N <= mean v N.
Proof.
  intros H. unfold mean. apply Rmult_le_compat_r; [left; apply Rinv_0_lt_compat, lt_0_INR; lia|]. now apply sum_Rle.
Qed.

Lemma mean_affine v N p q : mean (fun k => p * v k - q) N = p * mean v N - q.
Proof.
  unfold mean. assert (sum_f_R0 (fun k => p * v k - q) N = p * sum_f_R0 v N - q * INR (S N)) as ->.
  { induction N; [simpl; ring|]. rewrite !tech5, IHN, (S_INR (S N)). ring. }
  field. apply not_0_INR. lia.
Qed.

(* One attitude: the norm error of the estimate g + f w is at least this. *)
Lemma one_attitude_error (g w : vec) (G f : R) :
  0 < G -> norm g = G ->
  2 * Rabs f / (2 * G + Rabs f * norm w) * Rabs (dot g w - (- f * norm2 w / 2)) <= Rabs (norm (vadd g (scale f w)) - G).
Proof.
  intros PG HG. set (x := vadd g (scale f w)). pose proof (norm_nonneg x) as Nx. pose proof (norm_nonneg w) as Nw.
  pose proof (Rabs_pos f) as Pf. assert (0 <= Rabs f * norm w) by now apply Rmult_le_pos.
  assert (norm x <= G + Rabs f * norm w) as Up.
  { unfold x. apply Rle_trans with (1 := norm_triangle _ _). rewrite norm_scale. lra. }
  assert (Rabs (norm x - G) * (norm x + G) = 2 * Rabs f * Rabs (dot g w - (- f * norm2 w / 2))) as Product.
  { assert ((norm x - G) * (norm x + G) = 2 * f * (dot g w - (- f * norm2 w / 2))) as E.
    { replace ((norm x - G) * (norm x + G)) with (norm x * norm x - G * G) by ring.
      rewrite <- HG, !norm_sq. unfold x. vec_unfold. field. }
    apply (f_equal Rabs) in E. rewrite !Rabs_mult, (Rabs_pos_eq (norm x + G)), (Rabs_pos_eq 2) in E by lra. exact E. }
  apply (Rmult_le_reg_r (2 * G + Rabs f * norm w)); [lra|].
  replace (2 * Rabs f / (2 * G + Rabs f * norm w) * Rabs (dot g w - (- f * norm2 w / 2)) * (2 * G + Rabs f * norm w))
    with (2 * Rabs f * Rabs (dot g w - (- f * norm2 w / 2))) by (field; lra).
  rewrite <- Product. apply Rmult_le_compat_l; [apply Rabs_pos|]. lra.
Qed.

(* T9. xi measures how much the attitude changes as the triple's dual vector sees it: no constant comes closer to the g_k.w
   on average (the median does best). Noise moves each estimate by at most c(T) e. *)
Theorem T9_excitation (g x : nat -> vec) (w : vec) (N : nat) (G f xi ce : R) :
  0 < G -> (forall k, (k <= N)%nat -> norm (g k) = G) ->
  (forall t, xi <= mean (fun k => Rabs (dot (g k) w - t)) N) ->
  (forall k, (k <= N)%nat -> norm (vsub (x k) (vadd (g k) (scale f w))) <= ce) ->
  2 * Rabs f * xi / (2 * G + Rabs f * norm w) - ce <= mean (fun k => Rabs (norm (x k) - G)) N.
Proof.
  intros PG HG Xi Noise. set (p := 2 * Rabs f / (2 * G + Rabs f * norm w)).
  pose proof (Rabs_pos f). pose proof (norm_nonneg w). assert (0 <= Rabs f * norm w) by now apply Rmult_le_pos.
  assert (0 <= p) as Pp by (unfold p; apply Rle_mult_inv_pos; lra).
  replace (2 * Rabs f * xi / (2 * G + Rabs f * norm w)) with (p * xi) by (unfold p; field; lra).
  specialize (Xi (- f * norm2 w / 2)).
  apply Rle_trans with (mean (fun k => p * Rabs (dot (g k) w - (- f * norm2 w / 2)) - ce) N).
  - rewrite mean_affine. assert (p * xi <= p * mean (fun k => Rabs (dot (g k) w - (- f * norm2 w / 2))) N)
      by now apply Rmult_le_compat_l. lra.
  - apply mean_le. intros k Hk. pose proof (one_attitude_error (g k) w G f PG (HG k Hk)) as One. fold p in One.
    specialize (Noise k Hk). set (z := vadd (g k) (scale f w)) in *.
    pose proof (norm_add_close z (vsub (x k) z)) as Close.
    replace (vadd z (vsub (x k) z)) with (x k) in Close by (apply vec_eq; unfold vadd, vsub; simpl; ring).
    pose proof (Rabs_triang (norm (x k) - G) (- (norm (x k) - norm z))) as Tri. rewrite Rabs_Ropp in Tri.
    replace (norm (x k) - G + - (norm (x k) - norm z)) with (norm z - G) in Tri by ring. lra.
Qed.

(* T10. Seen by its length alone, a fault across gravity tilts the estimate by acos(G / (G + delta)) before it is noticed:
   there is one with exactly that cosine and a length that is off by exactly delta. *)
Theorem T10_tilt_floor (g w : vec) (G delta : R) :
  0 < G -> 0 < delta -> norm g = G -> dot g w = 0 -> 0 < norm w ->
  exists f, let x := vadd g (scale f w) in norm x = G + delta /\ dot x g / (norm x * norm g) = G / (G + delta).
Proof.
  intros PG Pd HG Orth Pw. set (r := 2 * G * delta + delta * delta).
  assert (0 < r) as Pr by (unfold r; nra).
  exists (sqrt r / norm w). intros x.
  assert (norm2 x = (G + delta) * (G + delta)) as N2.
  { unfold x. replace (norm2 (vadd g (scale (sqrt r / norm w) w)))
      with (norm2 g + 2 * (sqrt r / norm w) * dot g w + sqrt r / norm w * (sqrt r / norm w) * norm2 w) by (vec_unfold; ring).
    rewrite Orth, <- (norm_sq g), <- (norm_sq w), HG.
    replace (G * G + 2 * (sqrt r / norm w) * 0 + sqrt r / norm w * (sqrt r / norm w) * (norm w * norm w))
      with (G * G + sqrt r * sqrt r) by (field; lra).
    rewrite sqrt_sqrt by lra. unfold r. ring. }
  assert (norm x = G + delta) as Nx by (unfold norm; rewrite N2; apply sqrt_square; lra).
  split; [exact Nx|]. rewrite Nx, HG.
  replace (dot x g) with (norm2 g + sqrt r / norm w * dot g w) by (unfold x; vec_unfold; ring).
  rewrite Orth, <- norm_sq, HG. field. lra.
Qed.

(* T10, the mirror: with gravity along the triple's dual vector the mirror fault turns the estimate upside down. *)
Theorem T10_mirror_upside_down (w : vec) (s : R) :
  0 < norm2 w -> let g := scale s w in vadd g (scale (mirror_fault g w) w) = scale (-1) g.
Proof.
  intros Pw g. assert (mirror_fault g w = -2 * s) as ->.
  { unfold mirror_fault, g. replace (dot (scale s w) w) with (s * norm2 w) by (vec_unfold; ring). field. lra. }
  unfold g. vec_ring.
Qed.
