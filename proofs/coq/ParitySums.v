(* R3: parity added up over the stations of an episode (docs/theory.md, section 5.3). The parity of a healthy set, added up
   over K stations, is the added parity of its noise plus at most the sum of its systematic bounds b_k: whatever the other
   sensors read, whatever the attitudes are. So a test with this allowance keeps every healthy set whose noise is in bounds;
   a test that allows for less than the sum rejects healthy sets once K is large.
   Readings and axes are those after whitening: divided by the noise of the sensor, multiplied by the root of the samples. *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors.
Open Scope R_scope.

Fixpoint total (n : nat) (f : nat -> R) : R := match n with O => 0 | S m => total m f + f m end.

Lemma total_same n f g : (forall i, (i < n)%nat -> f i = g i) -> total n f = total n g.
Proof. induction n; simpl; intros H; [reflexivity|]. rewrite IHn, (H n); [reflexivity|lia|intros; apply H; lia]. Qed.
Lemma total_add n f g : total n (fun i => f i + g i) = total n f + total n g.
Proof. induction n; simpl; [ring|]. rewrite IHn. ring. Qed.
Lemma total_scale n c f : total n (fun i => c * f i) = c * total n f.
Proof. induction n; simpl; [ring|]. rewrite IHn. ring. Qed.
Lemma total_const n c : total n (fun _ => c) = INR n * c.
Proof. induction n; [simpl; ring|]. rewrite S_INR. simpl total. rewrite IHn. ring. Qed.
Lemma total_bounded n f b : (forall i, (i < n)%nat -> Rabs (f i) <= b i) -> Rabs (total n f) <= total n b.
Proof.
  induction n; simpl; intros H; [rewrite Rabs_R0; lra|]. apply Rle_trans with (1 := Rabs_triang _ _).
  apply Rplus_le_compat; [apply IHn; intros; apply H; lia|apply H; lia].
Qed.

Section Parity.
  Variables (n : nat) (h : nat -> vec).

  (* The weights v applied to what the sensors of S read. *)
  Definition along (S : set) (v y : nat -> R) : R := total n (fun i => if S i then v i * y i else 0).
  (* v is a parity functional of S: the weighted axes of S add up to zero, so no vector shows in it. *)
  Definition parity (S : set) (v : nat -> R) : Prop := forall x, along S v (fun i => dot (h i) x) = 0.
  (* The parity of S is at most L long: no parity functional of length 1 reads more. See [R3_length_of_projection]. *)
  Definition parity_within (S : set) (y : nat -> R) (L : R) : Prop :=
    forall v, parity S v -> along S v v <= 1 -> Rabs (along S v y) <= L.

  Lemma along_same S v y z : (forall i, (i < n)%nat -> S i = true -> y i = z i) -> along S v y = along S v z.
  Proof. intros H. apply total_same. intros i Hi. destruct (S i) eqn:Si; [now rewrite (H i Hi Si)|reflexivity]. Qed.
  Lemma along_add S v y z : along S v (fun i => y i + z i) = along S v y + along S v z.
  Proof. unfold along. rewrite <- total_add. apply total_same. intros i _. destruct (S i); ring. Qed.
  Lemma along_scale S c v y : along S (fun i => c * v i) y = c * along S v y.
  Proof. unfold along. rewrite <- total_scale. apply total_same. intros i _. destruct (S i); ring. Qed.
  Lemma along_comm S v y : along S v y = along S y v.
  Proof. apply total_same. intros i _. destruct (S i); ring. Qed.

  (* One sum a sensor is enough: the parity of the added readings is the added parity. *)
  Theorem R3_one_number_a_sensor (S : set) (v : nat -> R) (K : nat) (y : nat -> nat -> R) :
    along S v (fun i => total K (fun k => y k i)) = total K (fun k => along S v (y k)).
  Proof.
    induction K; simpl.
    - transitivity (total n (fun _ => 0)); [|rewrite total_const; ring].
      apply total_same. intros i _. destruct (S i); ring.
    - now rewrite along_add, IHK.
  Qed.

  Lemma cauchy (S : set) (v p : nat -> R) : 0 <= along S v v /\ Rsqr (along S v p) <= along S v v * along S p p.
  Proof.
    assert (0 <= along S v v /\ 0 <= along S p p /\ Rsqr (along S v p) <= along S v v * along S p p) as H; [|tauto].
    unfold along, Rsqr. induction n as [|m IH]; simpl; [lra|]. destruct IH as [A [B P]].
    set (a := total m (fun i => if S i then v i * v i else 0)) in *.
    set (b := total m (fun i => if S i then p i * p i else 0)) in *.
    set (c := total m (fun i => if S i then v i * p i else 0)) in *. destruct (S m); [|rewrite !Rplus_0_r; tauto].
    generalize (v m) (p m). intros x z. repeat split; [nra|nra|].
    assert (2 * c * (x * z) <= a * (z * z) + b * (x * x)); [|nra]. destruct (Req_dec a 0) as [Z|Nz].
    - rewrite Z in *. assert (c = 0) as -> by nra. nra.
    - apply (Rmult_le_reg_l a); [lra|]. pose proof (Rle_0_sqr (a * z - c * x)). unfold Rsqr in *.
      assert (0 <= (a * b - c * c) * (x * x)) by (apply Rmult_le_pos; nra). nra.
  Qed.

  (* [parity_within] is the Euclidean length of all parity rows: that of p, the projection of y on the parity space, which
     is the residual of least squares. *)
  Theorem R3_length_of_projection (S : set) (y p : nat -> R) (L : R) :
    parity S p -> (forall v, parity S v -> along S v y = along S v p) -> 0 <= L ->
    (parity_within S y L <-> sqrt (along S p p) <= L).
  Proof.
    intros Pp Proj PL. destruct (cauchy S p p) as [Pos _]. pose proof (sqrt_pos (along S p p)) as Ps.
    pose proof (sqrt_sqrt _ Pos) as Sq. set (s := sqrt (along S p p)) in *. split.
    - intros W. destruct (Req_dec s 0) as [Z|Nz]; [lra|].
      assert (parity S (fun i => / s * p i)) as Pu by (intros x; rewrite along_scale, (Pp x); ring).
      specialize (W _ Pu). rewrite (Proj _ Pu), (along_scale _ _ _ p), along_scale, along_comm, along_scale, <- Sq in W.
      replace (/ s * (s * s)) with s in W by (field; exact Nz). rewrite Rinv_l in W by exact Nz.
      rewrite Rabs_pos_eq in W by exact Ps. apply W. lra.
    - intros Le v Pv One. rewrite (Proj v Pv). destruct (cauchy S v p) as [V C]. rewrite <- Sq in C.
      rewrite <- (Rabs_pos_eq L PL). apply Rsqr_le_abs_0. apply Rle_trans with (1 := C). unfold Rsqr. nra.
  Qed.

  (* The systematic bound of all monitored sensors serves every set of them: parity of fewer is part of that of all. *)
  Theorem R3_parity_of_fewer (A T : set) (y : nat -> R) (L : R) :
    subset n A T -> parity_within T y L -> parity_within A y L.
  Proof.
    intros Sub W v Pv One. set (u := fun i => if A i then v i else 0).
    assert (forall z, along T u z = along A v z) as E.
    { intros z. apply total_same. intros i Hi. unfold u. destruct (A i) eqn:Ai; [now rewrite (Sub i Hi Ai)|].
      destruct (T i); ring. }
    rewrite <- E. apply W; [intros x; rewrite E; apply Pv|]. rewrite E.
    rewrite (along_same A v u v); [exact One|]. intros i _ Ai. unfold u. now rewrite Ai.
  Qed.

  (* K stations. S is healthy: its readings are gravity, at any attitude, noise nu and what is systematic, d. Nothing is
     said of y at the sensors outside of S. *)
  Section Episode.
    Variables (K : nat) (S : set) (g : nat -> vec) (y nu d : nat -> nat -> R) (b : nat -> R).
    Hypothesis healthy :
      forall k i, (k < K)%nat -> (i < n)%nat -> S i = true -> y k i = dot (h i) (g k) + nu k i + d k i.

    Lemma parity_of_station v k : parity S v -> (k < K)%nat -> along S v (y k) = along S v (nu k) + along S v (d k).
    Proof.
      intros Pv Hk. rewrite (along_same S v _ (fun i => dot (h i) (g k) + nu k i + d k i)) by (intros; now apply healthy).
      rewrite (along_add S v (fun i => dot (h i) (g k) + nu k i)), (along_add S v (fun i => dot (h i) (g k))), (Pv (g k)).
      ring.
    Qed.

    (* The added parity is that of the noise, and at most the sum of the bounds. *)
    Theorem R3_sum_of_parities (v : nat -> R) :
      parity S v -> (forall k, (k < K)%nat -> Rabs (along S v (d k)) <= b k) ->
      Rabs (total K (fun k => along S v (y k)) - total K (fun k => along S v (nu k))) <= total K b.
    Proof.
      intros Pv Bound. rewrite (total_same K _ (fun k => along S v (nu k) + along S v (d k)))
        by (intros; now apply parity_of_station).
      rewrite total_add. replace (_ + _ - _) with (total K (fun k => along S v (d k))) by ring. now apply total_bounded.
    Qed.

    (* While the added parity of the noise is at most q long, the set passes at q plus the sum of the bounds. *)
    Theorem R3_healthy_set_is_kept (q : R) :
      (forall k, (k < K)%nat -> parity_within S (d k) (b k)) ->
      parity_within S (fun i => total K (fun k => nu k i)) q ->
      parity_within S (fun i => total K (fun k => y k i)) (q + total K b).
    Proof.
      intros Bound Noise v Pv One. specialize (Noise v Pv One). rewrite R3_one_number_a_sensor in Noise |- *.
      pose proof (R3_sum_of_parities v Pv (fun k Hk => Bound k Hk v Pv One)) as Sum.
      apply Rabs_le_inv in Noise, Sum. apply Rabs_le. lra.
    Qed.
  End Episode.

  (* Why the sum: sensors without noise that are off by the same d at all stations, of parity b. Their added parity is K b,
     the whole sum. With any fixed allowance c instead (one b, or none), beside a noise limit that grows with the root of
     K, they are rejected from some K on, though healthy. *)
  Theorem R3_needs_the_sum_of_bounds (S : set) (v d : nat -> R) (b q c : R) :
    parity S v -> along S v v <= 1 -> along S v d = b -> 0 < b -> 0 <= q -> 0 <= c ->
    exists K0, forall K g, (K0 <= K)%nat ->
      along S v (fun i => total K (fun k => dot (h i) (g k) + d i)) = INR K * b /\
      ~ parity_within S (fun i => total K (fun k => dot (h i) (g k) + d i)) (q * sqrt (INR K) + c).
  Proof.
    intros Pv One D Pb Pq Pc. set (r := (q + c) / b + 1). assert (1 <= r) as Pr.
    { unfold r. assert (0 <= (q + c) / b) by (apply Rle_mult_inv_pos; lra). lra. }
    destruct (archimed_cor1 (/ (r * r))) as [K0 [Large PK0]]; [apply Rinv_0_lt_compat; nra|]. exists K0. intros K g HK.
    assert (r * r <= INR K0) as RK.
    { apply Rnot_lt_le. intros C. apply (Rlt_asym _ _ Large). apply Rinv_lt_contravar; [|exact C].
      apply lt_0_INR in PK0. apply Rmult_lt_0_compat; nra. }
    assert (along S v (fun i => total K (fun k => dot (h i) (g k) + d i)) = INR K * b) as E.
    { rewrite (R3_one_number_a_sensor S v K (fun k i => dot (h i) (g k) + d i)), <- total_const. apply total_same.
      intros k _. rewrite (along_add S v (fun i => dot (h i) (g k))), (Pv (g k)). lra. }
    split; [exact E|]. intros W. specialize (W v Pv One). rewrite E in W. apply Rabs_le_inv in W.
    apply le_INR in HK. assert (0 <= INR K) as PK by apply pos_INR. pose proof (sqrt_sqrt _ PK) as Sq.
    assert (r <= sqrt (INR K)) as R1 by (rewrite <- (sqrt_square r) by lra; apply sqrt_le_1_alt; lra).
    set (x := sqrt (INR K)) in *. rewrite <- Sq in W.
    assert (b * r = q + c + b) as Br by (unfold r; field; lra). destruct W as [_ W].
    assert (x * (b * r) <= x * (b * x)) as U by (apply Rmult_le_compat_l; [lra|apply Rmult_le_compat_l; lra]).
    rewrite Br in U. assert (c + b <= x * (c + b)) by nra. lra.
  Qed.
End Parity.

(* Such sensors exist: three axes at right angles and the unit axis (2, 2, 1)/3 between them. Only sensor 0 is off, by a
   tolerated amount b that is the same at all stations. *)
Theorem R3_a_tolerated_drift_is_rejected (b q c : R) :
  let axis := fun i =>
    match i with 0%nat => V 1 0 0 | 1%nat => V 0 1 0 | 2%nat => V 0 0 1 | _ => V (2 / 3) (2 / 3) (1 / 3) end in
  let drift := fun i => match i with 0%nat => b | _ => 0 end in
  0 < b -> 0 <= q -> 0 <= c ->
  exists K0, forall K g, (K0 <= K)%nat ->
    ~ parity_within 4 axis (fun _ => true) (fun i => total K (fun k => dot (axis i) (g k) + drift i)) (q * sqrt (INR K) + c).
Proof.
  intros axis drift Pb Pq Pc.
  set (v := fun i => match i with 0%nat => 2 / 5 | 1%nat => 2 / 5 | 2%nat => 1 / 5 | _ => - (3 / 5) end).
  destruct (R3_needs_the_sum_of_bounds 4 axis (fun _ => true) v drift (2 / 5 * b) q c) as [K0 H]; try assumption; try lra.
  - intros x. unfold along, axis, v. simpl. vec_unfold. field.
  - unfold along, v. simpl. lra.
  - unfold along, drift, v. simpl. field.
  - exists K0. intros K g HK. now apply (H K g HK).
Qed.
