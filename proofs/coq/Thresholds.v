(* T7: how large a fault must be to be seen, and to be isolated, when every reading is within e of its sensor's truth. The
   parity question: is there any vector, of any length, that explains a set within e? *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors Sensors Quads.
Open Scope R_scope.

Section Thresholds.
  Variables (n : nat) (h : nat -> vec) (e : R) (g : vec) (y : nat -> R) (f : nat -> R).
  Hypothesis noise : forall i, (i < n)%nat -> Rabs (y i - (dot (h i) g + f i)) <= e.

  Definition within (x : vec) (S : set) : Prop :=
    forall i, (i < n)%nat -> S i = true -> Rabs (dot (h i) x - y i) <= e.

  (* kappa(U, i) = |h_i' W_U|_1: how far sensor i's reading can move when those of the triple U move by one. *)
  Definition kappa (a b c : nat) (i : nat) : R :=
    Rabs (dot (h i) (dual (h a) (h b) (h c))) + Rabs (dot (h i) (dual (h b) (h c) (h a))) +
    Rabs (dot (h i) (dual (h c) (h a) (h b))).

  Lemma healthy_moves_2e x S i :
    within x S -> (i < n)%nat -> S i = true -> f i = 0 -> Rabs (dot (h i) (vsub x g)) <= 2 * e.
  Proof.
    intros W Hi Si Fi. specialize (W i Hi Si). pose proof (noise i Hi) as N. rewrite Fi in N.
    rewrite dot_sub_r. apply Rabs_le_inv in W. apply Rabs_le_inv in N. apply Rabs_le. lra.
  Qed.

  (* The heart: if x explains a healthy independent triple and sensor i as well, the fault on i is small. *)
  Theorem T7_surviving_fault x S a b c i :
    within x S -> (a < n)%nat -> (b < n)%nat -> (c < n)%nat -> (i < n)%nat ->
    S a = true -> S b = true -> S c = true -> S i = true -> f a = 0 -> f b = 0 -> f c = 0 ->
    det (h a) (h b) (h c) <> 0 -> Rabs (f i) <= 2 * e * (1 + kappa a b c i).
  Proof.
    intros W Ha Hb Hc Hi Sa Sb Sc Si Fa Fb Fc D.
    pose proof (healthy_moves_2e x S a W Ha Sa Fa) as A. pose proof (healthy_moves_2e x S b W Hb Sb Fb) as B.
    pose proof (healthy_moves_2e x S c W Hc Sc Fc) as C.
    set (d := vsub x g) in *. pose proof (dual_expand _ _ _ D d) as E.
    assert (dot (h i) d = dot (h a) d * dot (h i) (dual (h a) (h b) (h c)) + dot (h b) d * dot (h i) (dual (h b) (h c) (h a))
                          + dot (h c) d * dot (h i) (dual (h c) (h a) (h b))) as M.
    { rewrite E at 1. rewrite !dot_add_r, !dot_scale_r. ring. }
    assert (forall p q, Rabs p <= 2 * e -> Rabs (p * q) <= 2 * e * Rabs q) as Mul.
    { intros p q Hp. rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|exact Hp]. }
    pose proof (Mul _ (dot (h i) (dual (h a) (h b) (h c))) A) as MA.
    pose proof (Mul _ (dot (h i) (dual (h b) (h c) (h a))) B) as MB.
    pose proof (Mul _ (dot (h i) (dual (h c) (h a) (h b))) C) as MC.
    specialize (W i Hi Si). pose proof (noise i Hi) as N. unfold d in M at 1. rewrite dot_sub_r in M.
    unfold kappa. apply Rabs_le_inv in MA, MB, MC, W, N. apply Rabs_le. lra.
  Qed.

  (* T7, detection: one fault above 2e(1 + kappa(U, i)) for one healthy triple U cannot be explained away. *)
  Theorem T7_detection a b c i :
    (a < n)%nat -> (b < n)%nat -> (c < n)%nat -> (i < n)%nat -> f a = 0 -> f b = 0 -> f c = 0 ->
    det (h a) (h b) (h c) <> 0 -> 2 * e * (1 + kappa a b c i) < Rabs (f i) ->
    ~ exists x, within x (fun _ => true).
  Proof.
    intros Ha Hb Hc Hi Fa Fb Fc D Big [x W].
    pose proof (T7_surviving_fault x _ a b c i W Ha Hb Hc Hi eq_refl eq_refl eq_refl eq_refl Fa Fb Fc D). lra.
  Qed.

  (* ... and, by T6, some four sensors show it: their parity check fails. *)
  Theorem T7_detection_by_fours a b c i :
    (4 <= n)%nat -> general_position n h ->
    (a < n)%nat -> (b < n)%nat -> (c < n)%nat -> (i < n)%nat -> f a = 0 -> f b = 0 -> f c = 0 ->
    det (h a) (h b) (h c) <> 0 -> 2 * e * (1 + kappa a b c i) < Rabs (f i) ->
    ~ forall p q r s, (p < q)%nat -> (q < r)%nat -> (r < s)%nat -> (s < n)%nat ->
        quad_passes (h p) (h q) (h r) (h s) e (y p) (y q) (y r) (y s).
  Proof.
    intros Four GP Ha Hb Hc Hi Fa Fb Fc D Big All.
    apply (T7_detection a b c i Ha Hb Hc Hi Fa Fb Fc D Big).
    apply (T6_fours_decide n h y e Four GP) in All as [x X]. exists x. intros j Hj _. now apply X.
  Qed.

  (* A set K of sensors resolves the fault on i if it holds an independent triple with a small enough kappa. *)
  Definition resolves (K : set) (i : nat) : Prop :=
    exists a b c, (a < n)%nat /\ (b < n)%nat /\ (c < n)%nat /\ K a = true /\ K b = true /\ K c = true /\
      det (h a) (h b) (h c) <> 0 /\ 2 * e * (1 + kappa a b c i) < Rabs (f i).

  (* T7, isolation: if every n-2m of the healthy sensors resolve every fault, then a set of at least n-m sensors that one
     vector explains within e has healthy sensors only, and the largest such set is the healthy set. *)
  Theorem T7_isolation (m : nat) (S0 S : set) :
    healthy n S0 f -> (card n (compl S0) <= m)%nat ->
    (forall K i, subset n K S0 -> (n <= card n K + 2 * m)%nat -> (i < n)%nat -> f i <> 0 -> resolves K i) ->
    (exists x, within x S) -> (n <= card n S + m)%nat -> subset n S S0 /\ ((card n S0 <= card n S)%nat -> same n S S0).
  Proof.
    intros He Few Res [x W] Big. pose proof (card_compl n S0) as CC. pose proof (card_overlap n S S0) as Ov.
    assert (subset n S S0) as Sub.
    { intros i Hi Si. apply He; [exact Hi|]. destruct (Req_dec (f i) 0) as [Z|Nz]; [exact Z|exfalso].
      assert (subset n (inter S S0) S0) as RS by (intros j _ Rj; now apply andb_prop in Rj).
      destruct (Res (inter S S0) i RS ltac:(lia) Hi Nz) as [a [b [c [Ha [Hb [Hc [Ra [Rb [Rc [D Lt]]]]]]]]]].
      unfold inter in Ra, Rb, Rc. apply andb_prop in Ra as [Sa Ra], Rb as [Sb Rb], Rc as [Sc Rc].
      apply He in Ra, Rb, Rc; try assumption.
      pose proof (T7_surviving_fault x S a b c i W Ha Hb Hc Hi Sa Sb Sc Si Ra Rb Rc D). lra. }
    split; [exact Sub|]. intros Le. now apply subset_same.
  Qed.

  (* T7, protection: whatever explains a set with the healthy sensors K in it is no farther from the truth than 2e times the
     size of the region that K's axes fence in - faults that are too small to be isolated included. *)
  Theorem T7_estimate_error x (S K : set) (size : R) :
    0 <= e -> (forall i, (i < n)%nat -> K i = true -> S i = true /\ f i = 0) ->
    (forall d, (forall i, (i < n)%nat -> K i = true -> Rabs (dot (h i) d) <= 1) -> norm d <= size) ->
    within x S -> norm (vsub x g) <= 2 * e * size.
  Proof.
    intros He In Fence W. assert (0 <= 2 * e) as P by lra.
    destruct (Req_dec e 0) as [Z|Nz].
    - (* without noise: any multiple of the error lies within the fence *)
      set (d := vsub x g). rewrite Z. replace (2 * 0 * size) with 0 by ring.
      apply Rnot_lt_le. intros Pos.
      assert (0 <= size) as Ps.
      { apply Rle_trans with (norm vzero); [apply norm_nonneg|]. apply Fence. intros.
        replace (dot (h i) vzero) with 0 by (vec_unfold; ring). rewrite Rabs_R0. lra. }
      assert (norm (scale ((size + 1) / norm d) d) <= size) as C.
      { apply Fence. intros i Hi Ri. destruct (In i Hi Ri) as [Si Fi].
        pose proof (healthy_moves_2e x S i W Hi Si Fi) as M. fold d in M. rewrite Z, Rmult_0_r in M.
        rewrite dot_scale_r. apply Rabs_le_inv in M. replace (dot (h i) d) with 0 by lra.
        rewrite Rmult_0_r, Rabs_R0. lra. }
      rewrite norm_scale, Rabs_pos_eq in C by (apply Rle_mult_inv_pos; lra).
      replace ((size + 1) / norm d * norm d) with (size + 1) in C by (field; lra). lra.
    - assert (0 < 2 * e) as Pe by lra. set (d := vsub x g).
      assert (norm (scale (/ (2 * e)) d) <= size) as C.
      { apply Fence. intros i Hi Ri. destruct (In i Hi Ri) as [Si Fi].
        pose proof (healthy_moves_2e x S i W Hi Si Fi) as M. fold d in M.
        rewrite dot_scale_r, Rabs_mult, (Rabs_pos_eq (/ (2 * e))) by (left; now apply Rinv_0_lt_compat).
        apply (Rmult_le_reg_l (2 * e)); [exact Pe|]. rewrite <- Rmult_assoc, Rinv_r; lra. }
      rewrite norm_scale, Rabs_pos_eq in C by (left; now apply Rinv_0_lt_compat).
      apply (Rmult_le_compat_l (2 * e)) in C; [|lra]. rewrite <- Rmult_assoc, Rinv_r in C; lra.
  Qed.
End Thresholds.
