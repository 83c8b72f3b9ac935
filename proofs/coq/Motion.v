(* T11: evidence in motion. The tool feels a specific force of any length and direction, so only parity speaks: it cancels
   the force, whatever it is. This file states what follows: the mean of a derivative from block sums, the limit of a healthy
   set, that blocks at rest and in motion may share one set of hypotheses, and what parity alone isolates and what not. *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors Sensors Soundness WorstCase ParitySums.
Open Scope R_scope.

(* Two adjacent blocks A and B of N samples, the period between samples dt. Step k goes from sample k to sample k + 1. Its
   weight counts the pairs (sample j of A, sample j of B) between which it lies: 1, 2, ... N, ... 2, 1, a triangle. *)
Definition triangle (N k : nat) : R := INR (Nat.min (k + 1) (2 * N - 1 - k)).
Definition mean (N : nat) (y : nat -> R) : R := total N y / INR N.

Lemma total_split a b f : total (a + b) f = total a f + total b (fun k => f (a + k)%nat).
Proof. induction b; [rewrite Nat.add_0_r; simpl; ring|]. rewrite Nat.add_succ_r. simpl. rewrite IHb. ring. Qed.
Lemma rising N y : total N (fun k => INR (k + 1) * (y (k + 1)%nat - y k)) = INR N * y N - total N y.
Proof. induction N; [simpl; ring|]. simpl total. rewrite IHN, Nat.add_1_r, S_INR. ring. Qed.
Lemma falling N z : total N (fun k => INR (N - k) * (z (k + 1)%nat - z k)) = total (S N) z - INR (S N) * z 0%nat.
Proof.
  rewrite (total_same N _ (fun k => INR (S N) * (z (k + 1)%nat - z k) + -1 * (INR (k + 1) * (z (k + 1)%nat - z k))))
    by (intros; rewrite minus_INR, S_INR, plus_INR by lia; simpl INR; ring).
  rewrite total_add, !total_scale, rising. simpl total. rewrite S_INR.
  assert (total N (fun k => z (k + 1)%nat - z k) = z N - z 0%nat) as ->; [|ring].
  induction N; simpl; [ring|]. rewrite IHN, Nat.add_1_r. ring.
Qed.
Lemma triangle_sum N y : (0 < N)%nat ->
  total (2 * N - 1) (fun k => triangle N k * (y (k + 1)%nat - y k)) = total N (fun k => y (N + k)%nat) - total N y.
Proof.
  destruct N as [|M]; [lia|]. intros _. replace (2 * S M - 1)%nat with (S M + M)%nat by lia. rewrite total_split.
  rewrite (total_same (S M) _ (fun k => INR (k + 1) * (y (k + 1)%nat - y k)))
    by (intros k Hk; unfold triangle; do 2 f_equal; lia).
  rewrite (total_same M _ (fun k => INR (M - k) * (y (S M + (k + 1))%nat - y (S M + k)%nat)))
    by (intros k Hk; unfold triangle; rewrite Nat.add_assoc; do 2 f_equal; lia).
  rewrite rising, (falling M (fun k => y (S M + k)%nat)), Nat.add_0_r. ring.
Qed.

(* The triangle-weighted mean of the derivative is the difference of the two block means, divided by N dt, the time between
   the blocks. It is exact for every signal, and needs two sums only. *)
Theorem T11_mean_derivative (N : nat) (dt : R) (y : nat -> R) : (0 < N)%nat -> dt <> 0 ->
  total (2 * N - 1) (triangle N) = INR N * INR N /\
  total (2 * N - 1) (fun k => triangle N k * ((y (k + 1)%nat - y k) / dt)) / total (2 * N - 1) (triangle N) =
    (mean N (fun k => y (N + k)%nat) - mean N y) / (INR N * dt).
Proof.
  intros PN Pt. assert (INR N <> 0) as Nz by (apply not_0_INR; lia).
  assert (total (2 * N - 1) (triangle N) = INR N * INR N) as W.
  { pose proof (triangle_sum N INR PN) as T.
    rewrite (total_same _ _ (triangle N)) in T by (intros; rewrite Nat.add_1_r, S_INR; ring). rewrite T.
    rewrite (total_same N (fun k => INR (N + k)) (fun k => INR N + INR k)) by (intros; apply plus_INR).
    rewrite total_add, total_const. ring. }
  split; [exact W|].
  rewrite W, (total_same _ _ (fun k => / dt * (triangle N k * (y (k + 1)%nat - y k)))) by (intros; now field).
  rewrite total_scale, (triangle_sum N y PN). unfold mean. field. now split.
Qed.

(* A null vector v of a set Q: the axes of Q, weighted with v, add up to zero (ParitySums). Q is rejected if the parity of its
   readings is above q, for noise, plus the sum of |v_i| err_i. *)
Section Limits.
  Variables (n : nat) (h : nat -> vec).

  Definition limit (q : R) (Q : set) (v err : nat -> R) : R := q + along n Q (fun i => Rabs (v i)) err.
  Definition rejected (q : R) (Q : set) (v err y : nat -> R) : Prop := limit q Q v err < Rabs (along n Q v y).

  (* A healthy set reads the specific force f, whatever it is, noise nu and errors e within err: it is not rejected. *)
  Theorem T11_parity_in_motion (q : R) (Q : set) (v err y nu e : nat -> R) (f : vec) :
    parity n h Q v -> (forall i, (i < n)%nat -> Q i = true -> y i = dot (h i) f + nu i + e i) ->
    (forall i, (i < n)%nat -> Q i = true -> Rabs (e i) <= err i) -> Rabs (along n Q v nu) <= q ->
    Rabs (along n Q v y) <= limit q Q v err /\ ~ rejected q Q v err y.
  Proof.
    intros Null Read Err Noise. assert (Rabs (along n Q v y) <= limit q Q v err); [|split; [|apply Rle_not_lt]; assumption].
    rewrite (along_same n Q v y _ Read), (along_add n Q v (fun i => dot (h i) f + nu i)),
      (along_add n Q v (fun i => dot (h i) f)), (Null f).
    assert (Rabs (along n Q v e) <= along n Q (fun i => Rabs (v i)) err) as B.
    { apply total_bounded. intros i Hi. destruct (Q i) eqn:Qi; [|rewrite Rabs_R0; lra].
      rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos|now apply Err]. }
    apply Rabs_le_inv in B, Noise. unfold limit. apply Rabs_le. lra.
  Qed.

  (* Some readings y are at full scale: the sensors feel z beyond them. Where every such member of Q can only have made the
     parity smaller, a parity above the limit still accuses the set. *)
  Theorem T11_at_full_scale (q : R) (Q : set) (v err y z nu e : nat -> R) (f : vec) :
    parity n h Q v -> (forall i, (i < n)%nat -> Q i = true -> z i = dot (h i) f + nu i + e i) ->
    (forall i, (i < n)%nat -> Q i = true -> Rabs (e i) <= err i) -> Rabs (along n Q v nu) <= q ->
    (forall i, (i < n)%nat -> Q i = true -> 0 <= v i * (z i - y i)) -> along n Q v y <= limit q Q v err.
  Proof.
    intros Null Read Err Noise Beyond.
    destruct (T11_parity_in_motion q Q v err z nu e f Null Read Err Noise) as [B _].
    apply Rabs_le_inv in B. apply Rle_trans with (along n Q v z); [|lra].
    unfold along. clear - Beyond. induction n as [|m IH]; simpl; [lra|].
    assert (total m (fun i => if Q i then v i * y i else 0) <= total m (fun i => if Q i then v i * z i else 0))
      by (apply IH; intros; apply Beyond; [lia|assumption]).
    destruct (Q m) eqn:Qm; [|lra]. specialize (Beyond m ltac:(lia) Qm). lra.
  Qed.

  (* The bounds are made of readings (scale and skew depend on the force). If those of Q are made of readings of Q alone,
     no other sensor widens or narrows its limit: what the others read does not matter. *)
  Theorem T11_outsiders_change_nothing (q : R) (Q : set) (v y z : nat -> R) (err : (nat -> R) -> nat -> R) :
    (forall a b, (forall i, (i < n)%nat -> Q i = true -> a i = b i) ->
      forall i, (i < n)%nat -> Q i = true -> err a i = err b i) ->
    (forall i, (i < n)%nat -> Q i = true -> y i = z i) ->
    (rejected q Q v (err y) y <-> rejected q Q v (err z) z).
  Proof.
    intros Own Same. unfold rejected, limit.
    rewrite (along_same n Q v y z Same), (along_same n Q _ (err y) (err z) (Own y z Same)). tauto.
  Qed.
End Limits.

(* A fault phi that raises the limit of its set by at most lambda |phi|, lambda < 1, cannot hide. L: the limit without it;
   S: what everything else takes off the statistic at most. *)
Theorem T11_own_limit (statistic limit_of_it phi L S lambda : R) :
  lambda < 1 -> limit_of_it <= L + lambda * Rabs phi -> Rabs phi - S <= statistic ->
  (L + S) / (1 - lambda) < Rabs phi -> limit_of_it < statistic.
Proof.
  intros Pl Li St Big. apply (Rmult_lt_compat_r (1 - lambda)) in Big; [|lra].
  replace ((L + S) / (1 - lambda) * (1 - lambda)) with (L + S) in Big by (field; lra). lra.
Qed.

(* An episode of K blocks, at rest and in motion in any order, with one set of hypotheses. [rejects k Q]: block k rejects the
   set Q, by whatever test. A fault set is consistent if no block rejected a set outside of it. *)
Section Episode.
  Variables (n K : nat) (rejects : nat -> set -> Prop).

  Definition consistent_faults (F : set) : Prop :=
    forall k Q, (k < K)%nat -> subset n Q (compl F) -> ~ rejects k Q.
  Definition isolated (m i : nat) : Prop := forall F, consistent_faults F -> (card n F <= m)%nat -> F i = true.

  (* S0, the sensors healthy throughout, are all but at most m, and no block rejects a set of them: none of them is isolated.
     The kind of a block does not matter, only that each of its rejections is sound. *)
  Theorem T11_never_the_healthy (m : nat) (S0 : set) :
    (forall k Q, (k < K)%nat -> subset n Q S0 -> ~ rejects k Q) ->
    (card n (compl S0) <= m)%nat -> forall i, S0 i = true -> ~ isolated m i.
  Proof.
    intros Sound Few i Si Iso. specialize (Iso (compl S0)). unfold compl at 3 in Iso. rewrite Si in Iso.
    discriminate Iso; [|exact Few]. intros k Q Hk Sub. apply Sound; [exact Hk|]. intros j Hj Qj.
    specialize (Sub j Hj Qj). unfold compl in Sub. now destruct (S0 j).
  Qed.
End Episode.

(* The tests of the two kinds. In every block parity, at the same limit. In a block at rest the length as well: a set is
   rejected if no vector whose length is within d of G explains its readings within eps. *)
Section BothKinds.
  Variables (n K : nat) (h : nat -> vec) (at_rest : nat -> Prop) (G d : R).
  Variables (q : nat -> set -> (nat -> R) -> R) (err : nat -> set -> nat -> R) (eps y : nat -> nat -> R).

  Definition by_parity (k : nat) (Q : set) : Prop :=
    exists v, parity n h Q v /\ rejected n (q k Q v) Q v (err k Q) (y k).
  Definition by_length (k : nat) (Q : set) : Prop := at_rest k /\ ~ exists x, Rabs (norm x - G) <= d /\
    forall i, (i < n)%nat -> Q i = true -> Rabs (dot (h i) x - y k i) <= eps k i.

  Theorem T11_at_rest_and_in_motion (m : nat) (S0 : set) (f : nat -> vec) (nu e : nat -> nat -> R) :
    (forall k i, (k < K)%nat -> (i < n)%nat -> S0 i = true -> y k i = dot (h i) (f k) + nu k i + e k i) ->
    (forall k Q i, (k < K)%nat -> subset n Q S0 -> (i < n)%nat -> Q i = true -> Rabs (e k i) <= err k Q i) ->
    (forall k Q v, (k < K)%nat -> subset n Q S0 -> parity n h Q v -> Rabs (along n Q v (nu k)) <= q k Q v) ->
    (forall k, (k < K)%nat -> at_rest k -> Rabs (norm (f k) - G) <= d) ->
    (forall k i, (k < K)%nat -> at_rest k -> (i < n)%nat -> S0 i = true -> Rabs (nu k i + e k i) <= eps k i) ->
    (card n (compl S0) <= m)%nat ->
    forall i, S0 i = true -> ~ isolated n K (fun k Q => by_parity k Q \/ by_length k Q) m i.
  Proof.
    intros Read Err Noise Length Eps Few. apply T11_never_the_healthy; [|exact Few].
    intros k Q Hk Sub [[v [Null Rej]]|[Rest None]].
    - revert Rej. apply (T11_parity_in_motion n h _ Q v _ _ (nu k) (e k) (f k) Null).
      + intros i Hi Qi. apply Read; [exact Hk|exact Hi|now apply Sub].
      + intros i Hi Qi. now apply Err.
      + now apply Noise.
    - apply None. exists (f k). split; [now apply Length|]. intros i Hi Qi. specialize (Sub i Hi Qi).
      rewrite (Read k i Hk Hi Sub). replace (_ - _) with (- (nu k i + e k i)) by ring. rewrite Rabs_Ropp. now apply Eps.
  Qed.
End BothKinds.

(* What parity alone isolates. No noise; a set is alive if one vector, of any length, explains it; one sensor i is faulty. *)
Section Isolation.
  Variables (n : nat) (h : nat -> vec) (c : nat).
  Definition accused_by_parity (y : nat -> R) (m i : nat) : Prop := accused n (fun S => consistent n h S y) m i.
  Definition only_fault (i : nat) (f : nat -> R) : Prop := f i <> 0 /\ forall j, (j < n)%nat -> j <> i -> f j = 0.

  Lemma healthy_but_one (i : nat) (f : nat -> R) : (i < n)%nat -> only_fault i f ->
    healthy n (compl (single i)) f /\ card n (compl (compl (single i))) = 1%nat.
  Proof.
    intros Hi [Fi Others]. split.
    - intros j Hj. unfold compl, single. destruct (Nat.eqb_spec i j) as [->|Ne]; simpl; split; try easy.
      intros _. apply Others; [exact Hj|congruence].
    - rewrite <- (card_single n i Hi). apply card_same. intros k _. apply negb_involutive.
  Qed.

  Lemma others_not_accused (m i j : nat) (g : vec) (f y : nat -> R) : (1 <= m)%nat -> (i < n)%nat -> only_fault i f ->
    (forall k, (k < n)%nat -> readings h g f k = y k) -> j <> i -> ~ accused_by_parity y m j.
  Proof.
    intros Pm Hi Only Same Ne. destruct (healthy_but_one i f Hi Only) as [He One].
    apply (T5_never_the_healthy n _ m (compl (single i))); [|lia|].
    - exists g. intros k Hk Sk. rewrite <- Same by exact Hk. unfold readings. apply He in Sk as ->; [ring|exact Hk].
    - unfold compl, single. destruct (Nat.eqb_spec i j); [congruence|reflexivity].
  Qed.

  (* Up to m faults assumed, m <= n - 2 - c (n - 4 in general position): i is isolated, whatever its fault and the force, and
     nobody else is. *)
  Theorem T11_isolable_in_motion (m i : nat) (g : vec) (f : nat -> R) :
    at_most_coplanar n h c -> (1 <= m)%nat -> (m + c + 2 <= n)%nat -> (i < n)%nat -> only_fault i f ->
    forall j, (j < n)%nat -> (accused_by_parity (readings h g f) m j <-> j = i).
  Proof.
    intros Cop Pm Few Hi Only j Hj. destruct (healthy_but_one i f Hi Only) as [He One]. split.
    - intros Acc. destruct (Nat.eq_dec j i) as [E|Ne]; [exact E|]. exfalso. revert Acc.
      now apply (others_not_accused m i j g f).
    - intros -> S [x E] Si. destruct (le_lt_dec (card n (compl S)) m) as [L|L]; [|exact L]. exfalso. apply (proj1 Only).
      pose proof (card_compl n S). pose proof (card_compl n (compl (single i))). pose proof (card_overlap n S (compl (single i))).
      enough (x = g) as -> by (specialize (E i Hi Si); unfold readings in E; lra).
      apply (agree_equal n h c x g (inter S (compl (single i))) Cop); [lia|]. intros k Hk Sk.
      apply andb_prop in Sk as [Sk Nk]. rewrite (E k Hk Sk). unfold readings. apply He in Nk as ->; [ring|exact Hk].
  Qed.

  (* Not at m = n - 1 - c (n - 3): i, outside a plane with c healthy axes, C, is explained together with these. *)
  Theorem T11_not_isolable_beyond (i : nat) (g v : vec) (f : nat -> R) (C : set) :
    card n C = c -> (forall j, (j < n)%nat -> C j = true -> dot (h j) v = 0 /\ f j = 0) ->
    (i < n)%nat -> dot (h i) v <> 0 -> ~ accused_by_parity (readings h g f) (n - 1 - c) i.
  Proof.
    intros Size Plane Hi Out Acc. assert (C i = false) as Ci by (destruct (C i) eqn:E; [now apply Plane in E|reflexivity]).
    enough (n - 1 - c < card n (compl (add i C)))%nat
      by (pose proof (card_compl n (add i C)); pose proof (card_add n i C Hi Ci); lia).
    apply Acc; [|unfold add, union, single; now rewrite Nat.eqb_refl].
    exists (vadd g (scale (f i / dot (h i) v) v)). intros j Hj Aj. unfold readings. rewrite dot_add_r, dot_scale_r.
    unfold add, union, single in Aj. destruct (Nat.eqb_spec i j) as [<-|Ne]; [now field|].
    destruct (Plane j Hj Aj) as [-> ->]. ring.
  Qed.
End Isolation.

(* Four sensors in general position (m = 1 = n - 3): any three readings are those of some vector. *)
Lemma without_one (h : nat -> vec) (j : nat) (y : nat -> R) : general_position 4 h -> (j < 4)%nat ->
  exists x, forall k, (k < 4)%nat -> k <> j -> dot (h k) x = y k.
Proof.
  intros Independent Hj.
  assert (forall a b c, (a < b)%nat -> (b < c)%nat -> (c < 4)%nat ->
    exists x, dot (h a) x = y a /\ dot (h b) x = y b /\ dot (h c) x = y c) as Solve.
  { intros a b c Ab Bc C4. pose proof (Independent a b c Ab Bc C4) as D. pose proof D as D1.
    rewrite <- det_rotate in D1. pose proof D1 as D2. rewrite <- det_rotate in D2.
    exists (vadd (scale (y a) (dual (h a) (h b) (h c))) (vadd (scale (y b) (dual (h b) (h c) (h a)))
      (scale (y c) (dual (h c) (h a) (h b))))).
    rewrite !dot_add_r, !dot_scale_r, !dual_self, !dual_second, !dual_third by assumption. lra. }
  destruct j as [|[|[|[|j]]]]; [destruct (Solve 1 2 3)%nat as [x E]|destruct (Solve 0 2 3)%nat as [x E]
    |destruct (Solve 0 1 3)%nat as [x E]|destruct (Solve 0 1 2)%nat as [x E]|]; try lia;
    exists x; intros [|[|[|[|k]]]] Hk Ne; try lia; tauto.
Qed.

(* The fault is detected: no vector explains all four. But any sensor j may be the faulty one: the same readings come from
   another force and a fault on j alone. So by parity nobody is isolated. *)
Theorem T11_four_detect_only (h : nat -> vec) (i : nat) (g : vec) (f : nat -> R) :
  general_position 4 h -> (i < 4)%nat -> only_fault 4 i f ->
  ~ consistent 4 h (fun _ => true) (readings h g f) /\
  (forall j, (j < 4)%nat -> exists x fj, only_fault 4 j fj /\
    forall k, (k < 4)%nat -> readings h x fj k = readings h g f k) /\
  (forall j, (j < 4)%nat -> ~ accused_by_parity 4 h (readings h g f) 1 j).
Proof.
  intros Independent Hi Only. destruct (healthy_but_one 4 i f Hi Only) as [He One].
  assert (~ consistent 4 h (fun _ => true) (readings h g f)) as Detected.
  { apply (T3_detection 4 h 2 g f (compl (single i))); [now apply general_position_coplanar|exact He| |lia].
    exists i. split; [exact Hi|apply Only]. }
  assert (forall j, (j < 4)%nat -> exists x fj, only_fault 4 j fj /\
    forall k, (k < 4)%nat -> readings h x fj k = readings h g f k) as Other.
  { intros j Hj. destruct (without_one h j (readings h g f) Independent Hj) as [x E].
    exists x, (fun k => readings h g f k - dot (h k) x). split; [split|].
    - intros Z. apply Detected. exists x. intros k Hk _. destruct (Nat.eq_dec k j) as [->|Ne]; [lra|now apply E].
    - intros k Hk Ne. rewrite (E k Hk Ne). ring.
    - intros k _. unfold readings at 1. ring. }
  split; [exact Detected|]. split; [exact Other|]. intros j Hj.
  assert (exists o, o < 4 /\ j <> o)%nat as [o [Ho Ne]] by (destruct j; [exists 1%nat|exists 0%nat]; lia).
  destruct (Other o Ho) as [x [fo [Oo Same]]]. now apply (others_not_accused 4 h 1 o j x fo).
Qed.
