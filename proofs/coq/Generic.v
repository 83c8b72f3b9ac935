(* T2: the paper's claim made true. n sensors in general position, any number of faults with three healthy sensors left, no
   noise, norm test of every triple: unless the fault values hit one of finitely many polynomials, the triples that pass
   are exactly the healthy ones. *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors Mirror Sensors Triples.
Open Scope R_scope.

(* What the faults fa, fb, fc add to the squared length of the triple's estimate: a polynomial of degree two in them. *)
Definition fault_polynomial (g a b c : vec) (fa fb fc : R) : R :=
  norm2 (estimate a b c fa fb fc) + 2 * dot g (estimate a b c fa fb fc).

Definition passes (a b c : vec) (G2 : R) (ya yb yc : R) : Prop := norm2 (estimate a b c ya yb yc) = G2.

(* A triple passes if and only if its polynomial vanishes. *)
Lemma passes_polynomial a b c g fa fb fc :
  det a b c <> 0 ->
  (passes a b c (norm2 g) (dot a g + fa) (dot b g + fb) (dot c g + fc) <-> fault_polynomial g a b c fa fb fc = 0).
Proof.
  intros D. unfold passes, fault_polynomial. rewrite estimate_split by exact D.
  generalize (estimate a b c fa fb fc). intros u.
  replace (norm2 (vadd g u)) with (norm2 g + (norm2 u + 2 * dot g u)) by (vec_unfold; ring). split; lra.
Qed.

(* It vanishes without faults. *)
Lemma polynomial_of_healthy g a b c : fault_polynomial g a b c 0 0 0 = 0.
Proof.
  unfold fault_polynomial. replace (estimate a b c 0 0 0) with vzero by (unfold estimate; vec_ring). vec_unfold. ring.
Qed.

(* It is not the zero polynomial: in each fault it is a parabola with the leading coefficient |w|^2 > 0 ... *)
Theorem T2_parabola g a b c fb fc :
  det a b c <> 0 -> exists p q, 0 < norm2 (dual a b c) /\
  forall fa, fault_polynomial g a b c fa fb fc = norm2 (dual a b c) * fa * fa + p * fa + q.
Proof.
  intros D. set (u := vadd (scale fb (dual b c a)) (scale fc (dual c a b))).
  exists (2 * dot (dual a b c) (vadd u g)), (norm2 u + 2 * dot g u). split; [now apply dual_pos|].
  intros fa. unfold fault_polynomial, estimate. fold u. generalize (dual a b c) u. intros. vec_unfold. ring.
Qed.

(* ... so whatever the other faults are, at most two values of this one are unlucky. *)
Theorem T2_two_unlucky_values g a b c fb fc x y z :
  det a b c <> 0 -> fault_polynomial g a b c x fb fc = 0 -> fault_polynomial g a b c y fb fc = 0 ->
  fault_polynomial g a b c z fb fc = 0 -> x = y \/ y = z \/ x = z.
Proof.
  intros D X Y Z. destruct (T2_parabola g a b c fb fc D) as [p [q [P E]]]. rewrite E in X, Y, Z.
  set (s := norm2 (dual a b c)) in *.
  destruct (Req_dec x y) as [XY|XY]; [now left|]. destruct (Req_dec y z) as [YZ|YZ]; [now right; left|].
  right; right.
  assert (s * (x + y) + p = 0) as A.
  { apply (Rmult_eq_reg_l (x - y)); [|lra]. rewrite Rmult_0_r. transitivity (s * x * x + p * x + q - (s * y * y + p * y + q)); [ring|lra]. }
  assert (s * (y + z) + p = 0) as B.
  { apply (Rmult_eq_reg_l (y - z)); [|lra]. rewrite Rmult_0_r. transitivity (s * y * y + p * y + q - (s * z * z + p * z + q)); [ring|lra]. }
  apply (Rmult_eq_reg_l s); [|lra]. lra.
Qed.

(* With a single fault one of the two is zero: a triple has exactly one unlucky fault, the mirror (T1). *)
Theorem T2_single_fault g a b c f :
  det a b c <> 0 -> f <> 0 -> (fault_polynomial g a b c f 0 0 = 0 <-> f = mirror_fault g (dual a b c)).
Proof.
  intros D Nz. assert (0 < norm2 (dual a b c)) as P by now apply dual_pos.
  pose proof (T1_mirror_unique g (dual a b c) f P) as U.
  replace (fault_polynomial g a b c f 0 0) with (norm2 (vadd g (scale f (dual a b c))) - norm2 g)
    by (unfold fault_polynomial, estimate; generalize (dual a b c) (dual b c a) (dual c a b); intros; vec_unfold; ring).
  split; intros H; [destruct U as [U _]; destruct U; [lra|contradiction|assumption]|].
  assert (norm2 (vadd g (scale f (dual a b c))) = norm2 g); [apply U; now right|lra].
Qed.

Section Array.
  Variables (n : nat) (h : nat -> vec) (g : vec) (f : nat -> R).
  Hypothesis general : general_position n h.

  Definition triple_passes (i j k : nat) : Prop :=
    passes (h i) (h j) (h k) (norm2 g) (readings h g f i) (readings h g f j) (readings h g f k).
  Definition lucky : Prop :=
    forall i j k, (i < j)%nat -> (j < k)%nat -> (k < n)%nat -> ~ (f i = 0 /\ f j = 0 /\ f k = 0) ->
    fault_polynomial g (h i) (h j) (h k) (f i) (f j) (f k) <> 0.

  (* T2: off the bad set a triple passes if and only if all its sensors are healthy. *)
  Theorem T2_passing_triples i j k :
    lucky -> (i < j)%nat -> (j < k)%nat -> (k < n)%nat -> (triple_passes i j k <-> f i = 0 /\ f j = 0 /\ f k = 0).
  Proof.
    intros L Hij Hjk Hk. unfold triple_passes, readings.
    rewrite passes_polynomial by now apply general. split.
    - intros Z. destruct (Req_dec (f i) 0) as [I|I], (Req_dec (f j) 0) as [J|J], (Req_dec (f k) 0) as [K|K];
        try tauto; exfalso; apply (L i j k Hij Hjk Hk); tauto.
    - intros [-> [-> ->]]. apply polynomial_of_healthy.
  Qed.

  (* ... and with three or more healthy sensors the union of the passing triples is exactly the healthy set. *)
  Theorem T2_union_is_healthy (S0 : set) i :
    lucky -> healthy n S0 f -> (3 <= card n S0)%nat -> (i < n)%nat ->
    (f i = 0 <-> exists p q r, (p < q)%nat /\ (q < r)%nat /\ (r < n)%nat /\ (i = p \/ i = q \/ i = r) /\
                               triple_passes p q r).
  Proof.
    intros L He Three Hi. split.
    - intros Fi. apply He in Fi; [|exact Hi].
      destruct (subset_of_size_with n S0 i 3 Hi Fi ltac:(lia)) as [B [BS [B3 Bi]]].
      destruct (three_members n B ltac:(lia)) as [p [q [r [Hpq [Hqr [Hr [Bp [Bq Br]]]]]]]].
      exists p, q, r. repeat split; try assumption.
      + (* i is one of the three members of B *)
        destruct (Nat.eq_dec i p), (Nat.eq_dec i q), (Nat.eq_dec i r); try tauto. exfalso.
        set (T := add p (add q (single r))).
        assert (card n T = 3)%nat as T3.
        { unfold T. rewrite !card_add, card_single; try lia; unfold add, union, single;
            repeat match goal with |- context [Nat.eqb ?x ?y] => destruct (Nat.eqb_spec x y); try lia end; reflexivity. }
        assert (subset n T B) as TB.
        { intros x Hx. unfold T, add, union, single.
          destruct (Nat.eqb_spec p x), (Nat.eqb_spec q x), (Nat.eqb_spec r x); subst; simpl; congruence. }
        pose proof (subset_same n T B TB ltac:(lia) i Hi) as E. rewrite Bi in E.
        unfold T, add, union, single in E.
        repeat match goal with H : context [Nat.eqb ?x ?y] |- _ => destruct (Nat.eqb_spec x y); try lia end.
      + apply T2_passing_triples; try assumption.
        repeat split; apply He; try lia; apply BS; try lia; assumption.
    - intros [p [q [r [Hpq [Hqr [Hr [Mem Pass]]]]]]].
      apply T2_passing_triples in Pass; try assumption. destruct Mem as [->|[->| ->]]; tauto.
  Qed.
End Array.
