(* T16, the dip as a second reference: beside its length, the part of gravity along the Earth's field m is known. A fault f
   of the sensor with axis a moves the estimate of the triple a, b, c by f w, w = dual a b c. *)
From Coq Require Import Reals Lra Psatz.
From Plumb Require Import Vectors Mirror.
Open Scope R_scope.

(* What both references accept in place of g. *)
Definition alike (g m g' : vec) : Prop := norm2 g' = norm2 g /\ dot g' m = dot g m.

(* T16, unseen: both references accept a fault, other than none, only if it is the mirror and w is across the field. *)
Theorem T16_unseen (g w m : vec) (f : R) :
  0 < norm2 w -> f <> 0 ->
  (alike g m (vadd g (scale f w)) <-> f = mirror_fault g w /\ dot w m = 0).
Proof.
  intros P N. unfold alike. rewrite (T1_mirror_unique g w f P).
  replace (dot (vadd g (scale f w)) m) with (dot g m + f * dot w m) by (vec_unfold; ring). split.
  - intros [[Z|M] D]; [contradiction|]. split; [exact M|]. nra.
  - intros [M D]. split; [now right|]. rewrite D. ring.
Qed.

(* ... across the field: the field lies in the plane of the two healthy axes, in which gravity is mirrored. *)
Theorem T16_field_in_the_mirror (a b c m : vec) :
  det a b c <> 0 -> (dot (dual a b c) m = 0 <-> det m b c = 0).
Proof.
  intros D. replace (dot (dual a b c) m) with (/ det a b c * det m b c) by (unfold dual; vec_unfold; ring). split.
  - intros Z. apply Rmult_integral in Z. destruct Z as [Z|Z]; [|exact Z].
    exfalso. revert Z. now apply Rinv_neq_0_compat.
  - intros ->. ring.
Qed.

(* T16, robust: what passes both references, of which the length is held to delta and the part along the field to an
   interval, is near no fault or the mirror, and moves the estimate along the field by less than that interval. *)
Theorem T16_unseen_within (g w m : vec) (f delta low high : R) :
  0 < norm2 w ->
  Rabs (norm (vadd g (scale f w)) - norm g) <= delta ->
  low <= dot g m <= high -> low <= dot (vadd g (scale f w)) m <= high ->
  norm2 w * (Rabs f * Rabs (f - mirror_fault g w)) <= 2 * norm g * delta + delta * delta
  /\ Rabs f * Rabs (dot w m) <= high - low.
Proof.
  intros P L I J. split.
  - pose proof (T1_mirror_identity g w f P) as E.
    rewrite <- Rabs_mult, <- (Rabs_pos_eq (norm2 w)), <- Rabs_mult by lra.
    replace (norm2 w * (f * (f - mirror_fault g w))) with (norm2 w * f * (f - mirror_fault g w)) by ring.
    rewrite <- E, <- !norm_sq. pose proof (norm_nonneg g). pose proof (norm_nonneg (vadd g (scale f w))).
    apply Rabs_le_inv in L. apply Rabs_le. split; nra.
  - replace (dot (vadd g (scale f w)) m) with (dot g m + f * dot w m) in J by (vec_unfold; ring).
    rewrite <- Rabs_mult. apply Rabs_le. lra.
Qed.

(* A vector across m and k lies along their cross product. *)
Lemma across_two (m k d : vec) :
  0 < norm2 (cross m k) -> dot m d = 0 -> dot k d = 0 ->
  d = scale (dot (cross m k) d / norm2 (cross m k)) (cross m k).
Proof.
  intros P M K. set (n := cross m k) in *.
  apply (three_axes_determine m k n).
  - replace (det m k n) with (norm2 n) by (unfold n; vec_unfold; ring). lra.
  - rewrite M, dot_scale_r. replace (dot m n) with 0 by (unfold n; vec_unfold; ring). ring.
  - rewrite K, dot_scale_r. replace (dot k n) with 0 by (unfold n; vec_unfold; ring). ring.
  - rewrite dot_scale_r. fold (norm2 n). field. lra.
Qed.

(* T16, two explanations: what both references and the sensor with axis k accept is g and its mirror in the plane of
   the field and k, and nothing else. *)
Theorem T16_two_explanations (g g' m k : vec) :
  0 < norm2 (cross m k) ->
  (alike g m g' /\ dot k g' = dot k g
   <-> g' = g \/ g' = vadd g (scale (mirror_fault g (cross m k)) (cross m k))).
Proof.
  intros P. set (n := cross m k) in *. split.
  - intros [[L D] K]. set (d := vsub g' g).
    assert (dot m d = 0) as Dm by (unfold d; rewrite dot_sub_r, (dot_comm m g'), (dot_comm m g); lra).
    assert (dot k d = 0) as Dk by (unfold d; rewrite dot_sub_r; lra).
    pose proof (across_two m k d P Dm Dk) as Along. fold n in Along. set (s := dot n d / norm2 n) in *.
    assert (g' = vadd g (scale s n)) as E by (rewrite <- Along; unfold d; vec_ring).
    rewrite E in L. apply (T1_mirror_unique g n s P) in L. destruct L as [Z|M].
    + left. rewrite E, Z. vec_ring.
    + right. now rewrite E, M.
  - intros [->| ->].
    + split; [split; reflexivity|reflexivity].
    + split; [split|].
      * apply T1_mirror_unique; [exact P|now right].
      * replace (dot (vadd g (scale (mirror_fault g n) n)) m) with (dot g m + mirror_fault g n * dot n m)
          by (vec_unfold; ring).
        replace (dot n m) with 0 by (unfold n; vec_unfold; ring). ring.
      * rewrite dot_add_r, dot_scale_r. replace (dot k n) with 0 by (unfold n; vec_unfold; ring). ring.
Qed.

(* The one fault of the sensor with axis a that the other one, but for that with axis k, explains as well. *)
Definition unlucky (g m a k : vec) : R := mirror_fault g (cross m k) * dot a (cross m k).

(* T16, the counter-example: at this value truth g with a faulty, and its mirror with the other one faulty, both explain
   the readings of a and k. *)
Theorem T16_unlucky_fault (g m a k : vec) :
  0 < norm2 (cross m k) ->
  let g' := vadd g (scale (mirror_fault g (cross m k)) (cross m k)) in
  alike g m g' /\ dot a g' = dot a g + unlucky g m a k /\ dot k g' = dot k g.
Proof.
  intros P g'. destruct (proj2 (T16_two_explanations g g' m k P)) as [A K]; [now right|].
  split; [exact A|]. split; [|exact K]. unfold g', unlucky. now rewrite dot_add_r, dot_scale_r.
Qed.

(* T16, named: of three sensors a fault of a that is none of two values is explained by no fault of b and by none of c. *)
Theorem T16_named (g m a b c : vec) (f : R) :
  0 < norm2 (cross m b) -> 0 < norm2 (cross m c) ->
  f <> 0 -> f <> unlucky g m a c -> f <> unlucky g m a b ->
  ~ (exists g', alike g m g' /\ dot a g' = dot a g + f /\ dot c g' = dot c g)
  /\ ~ (exists g', alike g m g' /\ dot a g' = dot a g + f /\ dot b g' = dot b g).
Proof.
  intros Pb Pc N Nc Nb.
  assert (forall k, 0 < norm2 (cross m k) -> f <> unlucky g m a k ->
            ~ (exists g', alike g m g' /\ dot a g' = dot a g + f /\ dot k g' = dot k g)) as Each.
  { intros k P U (g' & A & R & K). destruct (proj1 (T16_two_explanations g g' m k P)) as [->| ->]; [now split| |].
    - apply N. lra.
    - apply U. unfold unlucky. rewrite dot_add_r, dot_scale_r in R. lra. }
  split; now apply Each.
Qed.

(* T16, nothing true is left out: x = g + t w + p with p the errors of the healthy. The line q = x - t w meets the limits
   that are widened by what p can be. *)
Theorem T16_truth_is_kept (x g w m p : vec) (t rho along shortest longest low high : R) :
  x = vadd (vadd g (scale t w)) p ->
  norm p <= rho -> Rabs (dot p m) <= along ->
  shortest <= norm g <= longest -> low <= dot g m <= high ->
  let q := vsub x (scale t w) in
  shortest - rho <= norm q <= longest + rho /\ low - along <= dot q m <= high + along.
Proof.
  intros -> Hp Ha L D q.
  assert (q = vadd g p) as -> by (unfold q; vec_ring).
  pose proof (norm_add_close g p) as C. apply Rabs_le_inv in C. apply Rabs_le_inv in Ha.
  replace (dot (vadd g p) m) with (dot g m + dot p m) by (vec_unfold; ring). lra.
Qed.

Lemma Rabs_minus_one : Rabs (-1) = 1.
Proof. unfold Rabs. destruct (Rcase_abs (-1)); lra. Qed.

Lemma lagrange (a b : vec) : norm2 (cross a b) + dot a b * dot a b = norm2 a * norm2 b.
Proof. vec_unfold; ring. Qed.

(* T16, the turn: q is off gravity by an angle of which the sine is at most rho over gravity's length. *)
Theorem T16_turn (g p : vec) (rho : R) :
  norm p <= rho -> rho < norm g ->
  let q := vadd g p in norm (cross q g) <= rho * norm q /\ 0 < dot q g.
Proof.
  intros Hp Short q. pose proof (norm_nonneg p). pose proof (norm_nonneg q). split.
  - replace (cross q g) with (scale (-1) (cross q p)) by (unfold q; vec_ring).
    rewrite norm_scale. replace (Rabs (-1)) with 1 by now rewrite Rabs_minus_one. rewrite Rmult_1_l.
    apply Rle_trans with (norm q * norm p); [|nra].
    apply norm_le; [nra|]. pose proof (lagrange q p). rewrite <- !norm_sq in *. nra.
  - unfold q. replace (dot (vadd g p) g) with (norm2 g + dot p g) by (vec_unfold; ring).
    rewrite <- norm_sq. pose proof (cauchy_schwarz (scale (-1) p) g) as C.
    rewrite norm_scale in C. replace (Rabs (-1)) with 1 in C by now rewrite Rabs_minus_one.
    replace (dot (scale (-1) p) g) with (- dot p g) in C by (vec_unfold; ring). nra.
Qed.

(* T16, the ends are furthest: on the way from x to y the direction turns steadily, so the cosine to x is least at y. *)
Theorem T16_ends_are_furthest (x y : vec) (s t : R) :
  0 <= s -> 0 <= t ->
  let u := vadd (scale s x) (scale t y) in dot x y * norm u <= dot x u * norm y.
Proof.
  intros S T u.
  assert (vadd (scale s x) (scale t y) = vadd (scale t y) (scale s x)) as Swap by (apply vec_eq; simpl; ring).
  pose proof (norm_nonneg x) as Nx. pose proof (norm_nonneg y) as Ny.
  assert (dot x u = s * norm2 x + t * dot x y) as -> by (unfold u; vec_unfold; ring).
  rewrite <- norm_sq. pose proof (cauchy_schwarz x y) as C.
  assert (- dot x y <= norm x * norm y) as C'.
  { pose proof (cauchy_schwarz (scale (-1) x) y) as H. rewrite norm_scale in H.
    replace (Rabs (-1)) with 1 in H by now rewrite Rabs_minus_one.
    replace (dot (scale (-1) x) y) with (- dot x y) in H by (vec_unfold; ring). lra. }
  assert (norm u <= s * norm x + t * norm y) as Above.
  { unfold u. pose proof (norm_triangle (scale s x) (scale t y)) as H.
    rewrite !norm_scale, (Rabs_pos_eq s S), (Rabs_pos_eq t T) in H. exact H. }
  assert (t * norm y - s * norm x <= norm u) as Below.
  { unfold u. pose proof (norm_add_close (scale t y) (scale s x)) as H. rewrite !norm_scale, (Rabs_pos_eq s S), (Rabs_pos_eq t T) in H.
    apply Rabs_le_inv in H. rewrite Swap. lra. }
  destruct (Rle_dec 0 (dot x y)) as [P|P].
  - apply Rle_trans with (dot x y * (s * norm x + t * norm y)); [now apply Rmult_le_compat_l|].
    assert (0 <= s * norm x * (norm x * norm y - dot x y)) by (apply Rmult_le_pos; [nra|lra]). lra.
  - assert (dot x y * norm u <= dot x y * (t * norm y - s * norm x)) by nra.
    assert (0 <= s * norm x * (norm x * norm y + dot x y)) by (apply Rmult_le_pos; [nra|lra]). lra.
Qed.
