(* T6: noise is exactly a matter of fours. n sensors in general position, each reading within e of its sensor's truth: some
   vector explains all of them if and only if every four pass their own parity check. *)
From Coq Require Import Reals Lra Arith Lia Psatz.
From Plumb Require Import Vectors Sensors Helly.
Open Scope R_scope.

(* The parity row of four axes: these weights cancel their readings, whatever the vector. *)
Lemma parity_cancels a b c d x :
  det b c d * dot a x - det a c d * dot b x + det a b d * dot c x - det a b c * dot d x = 0.
Proof. vec_unfold. ring. Qed.

(* The check of one four: |p.y| <= e |p|_1. *)
Definition quad_passes (a b c d : vec) (e ya yb yc yd : R) : Prop :=
  Rabs (det b c d * ya - det a c d * yb + det a b d * yc - det a b c * yd)
    <= e * (Rabs (det b c d) + Rabs (det a c d) + Rabs (det a b d) + Rabs (det a b c)).

Definition slab (h : vec) (y e : R) (x : vec) : Prop := Rabs (dot h x - y) <= e.

Lemma slab_convex h y e : convex (slab h y e).
Proof.
  intros a b t A B T. unfold slab in *. rewrite dot_add_r, !dot_scale_r.
  replace ((1 - t) * dot h a + t * dot h b - y) with ((1 - t) * (dot h a - y) + t * (dot h b - y)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult, !(Rabs_pos_eq (_ - t)), (Rabs_pos_eq t) by lra.
  assert ((1 - t) * Rabs (dot h a - y) <= (1 - t) * e) by (apply Rmult_le_compat_l; [lra|exact A]).
  assert (t * Rabs (dot h b - y) <= t * e) by (apply Rmult_le_compat_l; [lra|exact B]). lra.
Qed.

Definition sign (p : R) : R := if Rle_dec 0 p then 1 else -1.
Lemma sign_abs p : p * sign p = Rabs p.
Proof. unfold sign. destruct (Rle_dec 0 p); [rewrite Rabs_pos_eq|rewrite Rabs_left]; lra. Qed.
Lemma sign_bound p t e : Rabs t <= e -> Rabs (t * sign p) <= e.
Proof.
  intros H. unfold sign. destruct (Rle_dec 0 p).
  - now rewrite Rmult_1_r.
  - replace (t * -1) with (- t) by ring. now rewrite Rabs_Ropp.
Qed.

(* Four slabs meet if and only if their parity check passes. *)
Theorem T6_one_four a b c d e ya yb yc yd :
  det a b c <> 0 ->
  ((exists x, slab a ya e x /\ slab b yb e x /\ slab c yc e x /\ slab d yd e x) <-> quad_passes a b c d e ya yb yc yd).
Proof.
  intros D. unfold quad_passes. set (pa := det b c d). set (pb := det a c d). set (pc := det a b d).
  set (pd := det a b c) in *. set (size := Rabs pa + Rabs pb + Rabs pc + Rabs pd). split.
  - intros [x [A [B [Cx Dx]]]]. unfold slab in *. pose proof (parity_cancels a b c d x) as Z.
    fold pa pb pc pd in Z.
    replace (pa * ya - pb * yb + pc * yc - pd * yd)
      with (- (pa * (dot a x - ya)) + pb * (dot b x - yb) + - (pc * (dot c x - yc)) + pd * (dot d x - yd)) by lra.
    assert (forall p r, Rabs r <= e -> Rabs (p * r) <= e * Rabs p) as M.
    { intros p r Hr. rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|exact Hr]. }
    pose proof (M pa _ A). pose proof (M pb _ B). pose proof (M pc _ Cx). pose proof (M pd _ Dx).
    unfold size. rewrite !Rmult_plus_distr_l.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [|assumption].
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [|now rewrite Rabs_Ropp].
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [now rewrite Rabs_Ropp|assumption].
  - intros Check. set (s := pa * ya - pb * yb + pc * yc - pd * yd) in *.
    assert (0 < size) as Ps.
    { unfold size. pose proof (Rabs_pos pa). pose proof (Rabs_pos pb). pose proof (Rabs_pos pc).
      pose proof (Rabs_pos_lt pd D). lra. }
    set (t := s / size).
    assert (Rabs t <= e) as T.
    { unfold t, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ size)) by (left; now apply Rinv_0_lt_compat).
      apply (Rmult_le_reg_r size); [exact Ps|]. rewrite Rmult_assoc, Rinv_l; lra. }
    (* spread the parity residual over the four, each by t in the direction of its weight *)
    set (ra := t * sign pa). set (rb := t * sign (- pb)). set (rc := t * sign pc). set (rd := t * sign (- pd)).
    assert (pa * ra + - pb * rb + pc * rc + - pd * rd = s) as Spread.
    { unfold ra, rb, rc, rd. transitivity (t * (pa * sign pa + - pb * sign (- pb) + pc * sign pc + - pd * sign (- pd))); [ring|].
      rewrite !sign_abs, !Rabs_Ropp. fold size. unfold t. field. lra. }
    set (x := vadd (scale (ya - ra) (dual a b c)) (vadd (scale (yb - rb) (dual b c a)) (scale (yc - rc) (dual c a b)))).
    assert (det b c a <> 0) as D1 by (rewrite det_rotate; exact D).
    assert (det c a b <> 0) as D2 by (rewrite <- det_rotate; exact D).
    assert (dot a x = ya - ra) as Xa.
    { unfold x. rewrite !dot_add_r, !dot_scale_r, dual_self, dual_third, dual_second by assumption. ring. }
    assert (dot b x = yb - rb) as Xb.
    { unfold x. rewrite !dot_add_r, !dot_scale_r, dual_second, dual_self, dual_third by assumption. ring. }
    assert (dot c x = yc - rc) as Xc.
    { unfold x. rewrite !dot_add_r, !dot_scale_r, dual_third, dual_second, dual_self by assumption. ring. }
    assert (dot d x = yd - rd) as Xd.
    { pose proof (parity_cancels a b c d x) as Z. fold pa pb pc pd in Z. rewrite Xa, Xb, Xc in Z.
      apply (Rmult_eq_reg_l pd); [|exact D]. unfold s in Spread. lra. }
    exists x. unfold slab. rewrite Xa, Xb, Xc, Xd.
    assert (forall y r, Rabs r <= e -> Rabs (y - r - y) <= e) as Final.
    { intros y r Hr. replace (y - r - y) with (- r) by ring. now rewrite Rabs_Ropp. }
    repeat split; apply Final; now apply sign_bound.
Qed.

(* T6. *)
Theorem T6_fours_decide (n : nat) (h : nat -> vec) (y : nat -> R) (e : R) :
  (4 <= n)%nat -> general_position n h ->
  ((exists x, forall i, (i < n)%nat -> slab (h i) (y i) e x) <->
   (forall i j k l, (i < j)%nat -> (j < k)%nat -> (k < l)%nat -> (l < n)%nat ->
      quad_passes (h i) (h j) (h k) (h l) e (y i) (y j) (y k) (y l))).
Proof.
  intros Hn GP. split.
  - intros [x Hx] i j k l Hij Hjk Hkl Hl. apply T6_one_four; [apply GP; lia|].
    exists x. repeat split; apply Hx; lia.
  - intros Q. apply (helly_in_space n (fun i => slab (h i) (y i) e)); [exact Hn|intros i; apply slab_convex|].
    intros i j k l Hij Hjk Hkl Hl. apply T6_one_four; [apply GP; lia|]. now apply Q.
Qed.
