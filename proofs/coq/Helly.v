(* Helly's theorem in space: convex sets of which every four have a point in common have one in common all together. It is
   the reason why questions about many sensors can be answered by fours (T6). By way of Radon's partition of five points. *)
From Coq Require Import Reals Lra Arith Lia Psatz.
From Plumb Require Import Vectors.
Open Scope R_scope.

(* k linear equations in k+1 unknowns have a solution that is not zero: elimination of the last unknown. *)
Lemma all_or_some (P : nat -> R) n : (forall i, (i < n)%nat -> P i = 0) \/ exists i, (i < n)%nat /\ P i <> 0.
Proof.
  induction n as [|n [All|[i [Hi Ni]]]].
  - left. intros i Hi. lia.
  - destruct (Req_dec (P n) 0) as [Z|Nz].
    + left. intros i Hi. destruct (Nat.eq_dec i n) as [->|Ne]; [exact Z|apply All; lia].
    + right. exists n. split; [lia|exact Nz].
  - right. exists i. split; [lia|exact Ni].
Qed.

Lemma sum_zero f k : (forall j, (j <= k)%nat -> f j = 0) -> sum_f_R0 f k = 0.
Proof. intros Z. induction k; simpl; [apply Z; lia|]. rewrite IHk, Z; [lra|lia|]. intros j Hj. apply Z. lia. Qed.

Lemma underdetermined k : forall a : nat -> nat -> R,
  exists x : nat -> R, (exists j, (j <= k)%nat /\ x j <> 0) /\
    forall i, (i < k)%nat -> sum_f_R0 (fun j => a i j * x j) k = 0.
Proof.
  induction k as [|k IH]; intros a.
  - exists (fun _ => 1). split; [exists 0%nat; split; [lia|lra]|]. intros i Hi. lia.
  - destruct (all_or_some (fun i => a i (S k)) (S k)) as [Zero|[p [Hp Np]]].
    + exists (fun j => if Nat.eqb j (S k) then 1 else 0). split.
      * exists (S k). split; [lia|]. rewrite Nat.eqb_refl. lra.
      * intros i Hi. simpl sum_f_R0. rewrite Nat.eqb_refl, Zero by exact Hi.
        rewrite sum_zero; [lra|]. intros j Hj. assert (Nat.eqb j (S k) = false) as -> by (apply Nat.eqb_neq; lia). lra.
    + (* equation p serves to eliminate; equation k takes its place among the first k *)
      set (b := fun i => if Nat.eqb i p then a k else a i).
      destruct (IH (fun i j => b i j - b i (S k) / a p (S k) * a p j)) as [x [[j [Hj Nj]] E]].
      set (last := - sum_f_R0 (fun j => a p j * x j) k / a p (S k)).
      set (y := fun j => if Nat.eqb j (S k) then last else x j).
      assert (forall r : nat -> R, sum_f_R0 (fun j => r j * y j) (S k) = sum_f_R0 (fun j => r j * x j) k + r (S k) * last) as Y.
      { intros r. simpl sum_f_R0. unfold y at 2. rewrite Nat.eqb_refl. f_equal. apply sum_eq. intros i Hi. unfold y.
        assert (Nat.eqb i (S k) = false) as -> by (apply Nat.eqb_neq; lia). reflexivity. }
      assert (sum_f_R0 (fun j => a p j * y j) (S k) = 0) as Ep by (rewrite Y; unfold last; field; exact Np).
      exists y. split.
      * exists j. split; [lia|]. unfold y. assert (Nat.eqb j (S k) = false) as -> by (apply Nat.eqb_neq; lia). exact Nj.
      * assert (forall i, (i < k)%nat -> sum_f_R0 (fun j => b i j * y j) (S k) = 0) as B.
        { intros i Hi. specialize (E i Hi). rewrite Y.
          assert (sum_f_R0 (fun j => (b i j - b i (S k) / a p (S k) * a p j) * x j) k =
                  sum_f_R0 (fun j => b i j * x j) k - b i (S k) / a p (S k) * sum_f_R0 (fun j => a p j * x j) k) as L.
          { rewrite scal_sum, <- minus_sum. apply sum_eq. intros q _. ring. }
          rewrite L in E. unfold last. rewrite <- E. field. exact Np. }
        intros i Hi. destruct (Nat.eq_dec i p) as [->|Ne]; [exact Ep|].
        destruct (Nat.eq_dec i k) as [->|Nk].
        -- assert (p < k)%nat as Hpk by lia. specialize (B p Hpk). unfold b in B. now rewrite Nat.eqb_refl in B.
        -- specialize (B i ltac:(lia)). unfold b in B.
           assert (Nat.eqb i p = false) as F by (apply Nat.eqb_neq; exact Ne). now rewrite F in B.
Qed.

Definition convex (C : vec -> Prop) : Prop :=
  forall a b t, C a -> C b -> 0 <= t <= 1 -> C (vadd (scale (1 - t) a) (scale t b)).

Definition weight (w : nat -> R) k : R := sum_f_R0 w k.
Definition blend (w : nat -> R) (P : nat -> vec) k : vec :=
  V (sum_f_R0 (fun j => w j * vx (P j)) k) (sum_f_R0 (fun j => w j * vy (P j)) k) (sum_f_R0 (fun j => w j * vz (P j)) k).

Lemma weight_nonneg w k : (forall j, (j <= k)%nat -> 0 <= w j) -> 0 <= weight w k.
Proof.
  unfold weight. intros N. induction k; simpl; [apply N; lia|].
  apply Rplus_le_le_0_compat; [apply IHk; intros j Hj; apply N; lia|apply N; lia].
Qed.

Lemma weight_zero w k : (forall j, (j <= k)%nat -> 0 <= w j) -> weight w k = 0 -> forall j, (j <= k)%nat -> w j = 0.
Proof.
  unfold weight. intros N Z. induction k; simpl in Z; intros j Hj.
  - replace j with 0%nat by lia. exact Z.
  - assert (0 <= weight w k) by (apply weight_nonneg; intros i Hi; apply N; lia). unfold weight in *.
    assert (0 <= w (S k)) by (apply N; lia).
    destruct (Nat.eq_dec j (S k)) as [->|Ne]; [lra|]. apply IHk; [intros i Hi; apply N; lia|lra|lia].
Qed.

(* A convex set holds every mixture of its points with weights that are not negative. *)
Lemma convex_blend C w P k :
  convex C -> (forall j, (j <= k)%nat -> 0 <= w j) -> (forall j, (j <= k)%nat -> 0 < w j -> C (P j)) ->
  0 < weight w k -> C (scale (/ weight w k) (blend w P k)).
Proof.
  intros Cv. induction k as [|k IH]; intros N In Pos.
  - unfold weight in *. simpl in *.
    replace (scale (/ w 0%nat) (blend w P 0)) with (P 0%nat); [apply In; [lia|exact Pos]|].
    apply vec_eq; unfold blend; simpl; field; lra.
  - assert (0 <= weight w k) as Wk by (apply weight_nonneg; intros j Hj; apply N; lia).
    assert (0 <= w (S k)) as Nk by (apply N; lia).
    assert (weight w (S k) = weight w k + w (S k)) as Ws by reflexivity.
    destruct (Req_dec (weight w k) 0) as [Z|Nz].
    + (* only the last point has weight *)
      assert (forall j, (j <= k)%nat -> w j = 0) as Zero by (apply weight_zero; [intros j Hj; apply N; lia|exact Z]).
      replace (scale (/ weight w (S k)) (blend w P (S k))) with (P (S k)); [apply In; [lia|lra]|].
      assert (forall c : vec -> R, sum_f_R0 (fun j => w j * c (P j)) k = 0) as S0.
      { intros c. apply sum_zero. intros j Hj. rewrite Zero by exact Hj. ring. }
      rewrite Ws, Z, Rplus_0_l in *. apply vec_eq; unfold blend; simpl; rewrite S0; field; lra.
    + assert (0 < weight w k) as Pk by lra.
      assert (C (scale (/ weight w k) (blend w P k))) as Ck.
      { apply IH; [intros j Hj; apply N; lia|intros j Hj; apply In; lia|exact Pk]. }
      destruct (Req_dec (w (S k)) 0) as [Zs|Ns].
      * replace (scale (/ weight w (S k)) (blend w P (S k))) with (scale (/ weight w k) (blend w P k)); [exact Ck|].
        rewrite Ws, Zs, Rplus_0_r. apply vec_eq; unfold blend; simpl; rewrite Zs; ring.
      * assert (0 < w (S k)) as Ps by lra.
        replace (scale (/ weight w (S k)) (blend w P (S k))) with
          (vadd (scale (1 - w (S k) / weight w (S k)) (scale (/ weight w k) (blend w P k)))
                (scale (w (S k) / weight w (S k)) (P (S k)))).
        -- apply Cv; [exact Ck|apply In; [lia|exact Ps]|]. rewrite Ws. split.
           ++ apply Rle_mult_inv_pos; lra.
           ++ apply (Rmult_le_reg_r (weight w k + w (S k))); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
        -- rewrite Ws. apply vec_eq; unfold blend; simpl; field; lra.
Qed.

(* Radon: five points of space have a partition into two groups with a common mixture. *)
Lemma radon (P : nat -> vec) :
  exists u v : nat -> R, (forall j, (j <= 4)%nat -> 0 <= u j /\ 0 <= v j /\ (u j = 0 \/ v j = 0)) /\
    weight u 4 = weight v 4 /\ 0 < weight u 4 /\ blend u P 4 = blend v P 4.
Proof.
  destruct (underdetermined 4 (fun i j => match i with 0%nat => 1 | 1%nat => vx (P j) | 2%nat => vy (P j) | _ => vz (P j) end))
    as [l [[j0 [Hj0 Nj0]] E]].
  set (u := fun j => Rmax (l j) 0). set (v := fun j => Rmax (- l j) 0).
  assert (forall j, u j - v j = l j) as D.
  { intros j. unfold u, v, Rmax. destruct (Rle_dec (l j) 0), (Rle_dec (- l j) 0); lra. }
  assert (forall c : nat -> R, sum_f_R0 (fun j => c j * l j) 4 = 0 ->
    sum_f_R0 (fun j => u j * c j) 4 = sum_f_R0 (fun j => v j * c j) 4) as Same.
  { intros c Hc. simpl in *. rewrite <- !D in Hc. lra. }
  assert (weight u 4 = weight v 4) as W.
  { specialize (Same (fun _ => 1)). specialize (E 0%nat ltac:(lia)). simpl in E.
    assert (forall w, weight w 4 = sum_f_R0 (fun j => w j * 1) 4) as One by (intros w; unfold weight; simpl; ring).
    rewrite (One u), (One v). apply Same. simpl. lra. }
  assert (forall j, (j <= 4)%nat -> 0 <= u j /\ 0 <= v j /\ (u j = 0 \/ v j = 0)) as N.
  { intros j _. unfold u, v, Rmax. destruct (Rle_dec (l j) 0), (Rle_dec (- l j) 0); lra. }
  exists u, v. split; [exact N|]. split; [exact W|]. split.
  - assert (0 <= weight u 4) as Pu by (apply weight_nonneg; intros j Hj; now apply N).
    destruct (Req_dec (weight u 4) 0) as [Z|Nz]; [|lra]. exfalso. apply Nj0. rewrite <- D.
    rewrite (weight_zero u 4) by (try assumption; intros j Hj; now apply N).
    rewrite (weight_zero v 4) by (try assumption; try lra; intros j Hj; now apply N). ring.
  - apply vec_eq; unfold blend; cbn [vx vy vz]; apply Same;
      [exact (E 1%nat ltac:(lia))|exact (E 2%nat ltac:(lia))|exact (E 3%nat ltac:(lia))].
Qed.

(* Leaving one index out, in order. *)
Definition skip (j i : nat) : nat := if Nat.ltb i j then i else S i.
Lemma skip_lt j i i' : (i < i')%nat -> (skip j i < skip j i')%nat.
Proof. unfold skip. intros. destruct (Nat.ltb_spec i j), (Nat.ltb_spec i' j); lia. Qed.
Lemma skip_onto j i n : (i <= n)%nat -> i <> j -> (j <= n)%nat -> exists k, (k < n)%nat /\ skip j k = i.
Proof.
  intros. destruct (lt_dec i j).
  - exists i. split; [lia|]. unfold skip. now destruct (Nat.ltb_spec i j); [|lia].
  - exists (i - 1)%nat. split; [lia|]. unfold skip. destruct (Nat.ltb_spec (i - 1) j); lia.
Qed.

Theorem helly_in_space n : forall C : nat -> vec -> Prop,
  (4 <= n)%nat -> (forall i, convex (C i)) ->
  (forall i j k l, (i < j)%nat -> (j < k)%nat -> (k < l)%nat -> (l < n)%nat ->
    exists x, C i x /\ C j x /\ C k x /\ C l x) ->
  exists x, forall i, (i < n)%nat -> C i x.
Proof.
  induction n as [|n IH]; intros C Hn Cv Fours; [lia|].
  destruct (Nat.eq_dec n 3) as [->|N3].
  { destruct (Fours 0 1 2 3)%nat as [x [A [B [Cc D]]]]; try lia. exists x. intros i Hi.
    destruct i as [|[|[|[|i]]]]; try assumption; lia. }
  assert (forall j, (j <= 4)%nat -> exists x, forall i, (i <= n)%nat -> i <> j -> C i x) as Without.
  { intros j Hj. destruct (IH (fun i => C (skip j i))) as [x Hx]; [lia|intros i; apply Cv| |].
    - intros a b c d Hab Hbc Hcd Hd. apply Fours; try (now apply skip_lt). unfold skip. destruct (Nat.ltb d j); lia.
    - exists x. intros i Hi Ne. destruct (skip_onto j i n Hi Ne ltac:(lia)) as [k [Hk <-]]. now apply Hx. }
  destruct (Without 0%nat ltac:(lia)) as [p0 H0]. destruct (Without 1%nat ltac:(lia)) as [p1 H1].
  destruct (Without 2%nat ltac:(lia)) as [p2 H2]. destruct (Without 3%nat ltac:(lia)) as [p3 H3].
  destruct (Without 4%nat ltac:(lia)) as [p4 H4].
  set (P := fun j => match j with 0%nat => p0 | 1%nat => p1 | 2%nat => p2 | 3%nat => p3 | _ => p4 end).
  assert (forall j i, (j <= 4)%nat -> (i <= n)%nat -> i <> j -> C i (P j)) as HP.
  { intros j i Hj Hi Ne. destruct j as [|[|[|[|[|j]]]]]; [now apply H0|now apply H1|now apply H2|now apply H3|now apply H4|lia]. }
  destruct (radon P) as [u [v [N [W [Pos B]]]]].
  exists (scale (/ weight u 4) (blend u P 4)). intros i Hi.
  assert (forall w, (forall j, (j <= 4)%nat -> 0 <= w j) -> 0 < weight w 4 -> (forall j, (j <= 4)%nat -> i = j -> w j = 0) ->
    C i (scale (/ weight w 4) (blend w P 4))) as Mix.
  { intros w Nw Pw Zw. apply convex_blend; [apply Cv|exact Nw| |exact Pw].
    intros j Hj Pj. apply HP; [exact Hj|lia|]. intros Eq. specialize (Zw j Hj Eq). lra. }
  destruct (le_lt_dec i 4) as [Small|Large].
  - destruct (N i Small) as [_ [_ [Z|Z]]].
    + apply Mix; [intros j Hj; now apply N|exact Pos|]. intros j _ <-. exact Z.
    + rewrite W, B. apply Mix; [intros j Hj; now apply N|lra|]. intros j _ <-. exact Z.
  - apply Mix; [intros j Hj; now apply N|exact Pos|]. intros j Hj Eq. lia.
Qed.
