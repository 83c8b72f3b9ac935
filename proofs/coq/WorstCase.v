(* T3 and T4: what holds against faults of any size, colluding ones included. c = 2 is general position, where the
   bounds read |F| <= n - 3 and n >= 2m + 3. *)
From Coq Require Import Reals Lra Arith Bool Lia.
From Plumb Require Import Sets Vectors Sensors.
Open Scope R_scope.

Section WorstCase.
  Variable n : nat.
  Variable h : nat -> vec.
  Variable c : nat.

  (* T3: at least one and at most n - c - 1 faulty sensors cannot be explained by any vector, of any length. *)
  Theorem T3_detection (g : vec) (f : nat -> R) (S0 : set) :
    at_most_coplanar n h c -> healthy n S0 f ->
    (exists i, (i < n)%nat /\ f i <> 0) -> (card n (compl S0) + c + 1 <= n)%nat ->
    ~ consistent n h (fun _ => true) (readings h g f).
  Proof.
    intros Cop He [k [Hk Fk]] Few [x E]. pose proof (card_compl n S0) as CC.
    assert (x = g) as ->.
    { apply (agree_equal n h c x g S0 Cop); [lia|]. intros i Hi Si.
      rewrite (E i Hi eq_refl). unfold readings. apply He in Si as ->; [lra|exact Hi]. }
    apply Fk. specialize (E k Hk eq_refl). unfold readings in E. lra.
  Qed.

  (* T3 is sharp in c: a plane with c sensors leaves the c healthy ones and a mirrored vector indistinguishable. *)
  Theorem T3_sharp (C : set) (v g : vec) :
    (forall i, (i < n)%nat -> (C i = true <-> dot (h i) v = 0)) -> dot g v <> 0 -> norm2 v <> 0 ->
    exists f, healthy n C f /\ alive n h (norm g) (fun _ => true) (readings h g f).
  Proof.
    intros HC Gv Nv. set (s := - (2 * dot g v) / norm2 v). exists (fun i => s * dot (h i) v). split.
    - intros i Hi. rewrite (HC i Hi). assert (s <> 0).
      { unfold s. intros Z. apply Gv. apply (Rmult_eq_reg_l (-2 * / norm2 v)).
        - transitivity (- (2 * dot g v) / norm2 v); [field; exact Nv|]. rewrite Z. ring.
        - intros Y. apply Rmult_integral in Y as [Y|Y]; [lra|]. now apply Rinv_neq_0_compat in Y. }
      split; [intros ->; ring|]. intros Z. apply Rmult_integral in Z. tauto.
    - exists (vadd g (scale s v)). split.
      + rewrite norm_sq. replace (norm2 (vadd g (scale s v))) with (norm2 g + s * (2 * dot g v + s * norm2 v))
          by (vec_unfold; ring).
        replace (s * norm2 v) with (- (2 * dot g v)) by (unfold s; field; exact Nv). ring.
      + intros i _ _. unfold readings. rewrite dot_add_r, dot_scale_r. reflexivity.
  Qed.

  (* T4, sufficiency: with n >= 2m + c + 1 a consistent set at least as large as the healthy one IS the healthy one.
     The length of gravity is not needed for it. *)
  Theorem T4_sufficient (m : nat) (g : vec) (f : nat -> R) (S0 S : set) :
    at_most_coplanar n h c -> healthy n S0 f ->
    (card n (compl S0) <= m)%nat -> (2 * m + c + 1 <= n)%nat ->
    consistent n h S (readings h g f) -> (card n S0 <= card n S)%nat -> same n S S0.
  Proof.
    intros Cop He Few Big [x E] Le. pose proof (card_compl n S0). pose proof (card_overlap n S S0).
    assert (x = g) as ->.
    { apply (agree_equal n h c x g (inter S S0) Cop); [lia|]. intros i Hi Si.
      apply andb_prop in Si as [Si S0i]. rewrite (E i Hi Si). unfold readings. apply He in S0i as ->; [lra|exact Hi]. }
    apply subset_same; [|exact Le]. intros i Hi Si. apply He; [exact Hi|].
    specialize (E i Hi Si). unfold readings in E. lra.
  Qed.

  (* T4, necessity, the construction: the sensors outside a plane with normal v are split into F and F'. Then the same
     readings come from g with F faulty and from its mirror image g' with F' faulty, and |g'| = |g|. *)
  Theorem T4_two_truths (g v : vec) (C F : set) :
    v <> vzero -> dot g v <> 0 -> (forall i, (i < n)%nat -> (C i = true <-> dot (h i) v = 0)) ->
    (forall i, (i < n)%nat -> F i = true -> C i = false) ->
    exists g' f f', norm2 g' = norm2 g /\
      (forall i, readings h g f i = readings h g' f' i) /\
      healthy n (compl F) f /\ healthy n (union F C) f'.
  Proof.
    intros Ne Gv HC Out. assert (norm2 v <> 0) as Nv by (apply norm2_pos in Ne; lra).
    set (s := - (2 * dot g v) / norm2 v).
    assert (s * norm2 v = - (2 * dot g v)) as Sv by (unfold s; field; exact Nv).
    assert (s <> 0) as Sz by (intros Z; rewrite Z in Sv; lra).
    assert (forall i, (i < n)%nat -> C i = false -> s * dot (h i) v <> 0) as Off.
    { intros i Hi Ci Z. apply Rmult_integral in Z as [Z|Z]; [now apply Sz|].
      apply HC in Z; [|exact Hi]. congruence. }
    exists (vadd g (scale s v)), (fun i => if F i then s * dot (h i) v else 0),
      (fun i => if F i then 0 else - (s * dot (h i) v)).
    repeat split.
    - replace (norm2 (vadd g (scale s v))) with (norm2 g + s * (2 * dot g v + s * norm2 v)) by (vec_unfold; ring).
      rewrite Sv. ring.
    - intros i. unfold readings. rewrite dot_add_r, dot_scale_r. destruct (F i); ring.
    - unfold compl. destruct (F i) eqn:Fi; simpl; [discriminate|reflexivity].
    - unfold compl. destruct (F i) eqn:Fi; simpl; [|reflexivity]. intros Z. exfalso.
      now apply (Off i H (Out i H Fi)).
    - unfold union. destruct (F i) eqn:Fi; simpl; [reflexivity|]. intros Ci. apply HC in Ci as ->; [ring|exact H].
    - unfold union. destruct (F i) eqn:Fi; simpl; [reflexivity|]. intros Z. destruct (C i) eqn:Ci; [reflexivity|].
      exfalso. apply (Off i H Ci). lra.
  Qed.

  (* "Isolation in the worst case": whatever g of length G and whatever at most m faults, the largest set that is alive
     is unique and is the set of the healthy sensors. *)
  Definition isolable (G : R) (m : nat) : Prop :=
    forall g f S0 S, norm2 g = G * G -> healthy n S0 f -> (card n (compl S0) <= m)%nat ->
    alive n h G S (readings h g f) -> (card n S0 <= card n S)%nat -> same n S S0.

  (* T4, both directions, for an array with coplanarity number c. *)
  Theorem T4_worst_case_isolation (G : R) (m : nat) :
    0 < G -> coplanarity n h c -> (c < n)%nat -> (isolable G m <-> (2 * m + c + 1 <= n)%nat).
  Proof.
    intros HG [Cop [v [C [Ne [Cc HC]]]]] Cn. split.
    - intros Iso. destruct (le_lt_dec (2 * m + c + 1) n) as [L|L]; [exact L|]. exfalso.
      (* F: the larger half of the sensors outside the plane. *)
      pose proof (card_compl n C) as CC.
      set (k := ((card n (compl C) + 1) / 2)%nat).
      assert (2 * k <= card n (compl C) + 1 /\ card n (compl C) <= 2 * k)%nat as [K1 K2].
      { unfold k. pose proof (Nat.div_mod (card n (compl C) + 1) 2 ltac:(lia)).
        pose proof (Nat.mod_upper_bound (card n (compl C) + 1) 2 ltac:(lia)). lia. }
      destruct (subset_of_size n (compl C) k ltac:(lia)) as [F [FC Fk]].
      assert (forall i, (i < n)%nat -> F i = true -> C i = false) as Out.
      { intros i Hi Fi. specialize (FC i Hi Fi). unfold compl in FC. now destruct (C i). }
      assert (0 < norm2 v) as Pv by now apply norm2_pos.
      assert (0 < norm v) as Qv by (apply sqrt_lt_R0, Pv).
      set (g := scale (G / norm v) v).
      assert (norm2 g = G * G) as Gg.
      { unfold g. replace (norm2 (scale (G / norm v) v)) with (G / norm v * (G / norm v) * norm2 v)
          by (vec_unfold; ring). rewrite <- norm_sq. field. lra. }
      assert (dot g v <> 0) as Gv.
      { unfold g. replace (dot (scale (G / norm v) v) v) with (G / norm v * norm2 v) by (vec_unfold; ring).
        assert (0 < G / norm v) by (apply Rdiv_lt_0_compat; lra). nra. }
      destruct (T4_two_truths g v C F Ne Gv HC Out) as [g' [f [f' [Gl [Same [He He']]]]]].
      assert (card n (union F C) = k + c)%nat as Cu.
      { pose proof (card_inclusion n F C). assert (card n (inter F C) = card n (fun _ => false)) as Z.
        { apply card_same. intros i Hi. unfold inter. destruct (F i) eqn:Fi; [now rewrite (Out i Hi Fi)|reflexivity]. }
        assert (card n (fun _ => false) = 0)%nat by (clear; induction n; simpl; lia). lia. }
      pose proof (card_compl n F) as CF. pose proof (card_compl n (compl F)) as CF2.
      assert (same n (union F C) (compl F)) as Wrong.
      { apply (Iso g f (compl F) (union F C)); try assumption; try lia.
        exists g'. split; [lra|]. intros i Hi Ui. rewrite Same. unfold readings.
        apply He' in Ui as ->; [ring|exact Hi]. }
      (* But F is not empty, its members are in the one set and not in the other. *)
      assert (0 < card n F)%nat as Fpos by lia.
      destruct (card n F) eqn:E; [lia|].
      assert (exists i, (i < n)%nat /\ F i = true) as [i [Hi Fi]].
      { clear - E. induction n as [|p IH]; simpl in E; [lia|]. destruct (F p) eqn:Fp; [exists p; split; [lia|exact Fp]|].
        destruct IH as [i [Hi Fi]]; [lia|]. exists i. split; [lia|exact Fi]. }
      specialize (Wrong i Hi). unfold union, compl in Wrong. rewrite Fi in Wrong. discriminate Wrong.
    - intros Big g f S0 S _ He Few Al. apply (T4_sufficient m g f S0 S Cop He Few Big).
      now apply (alive_consistent n h G).
  Qed.
End WorstCase.
