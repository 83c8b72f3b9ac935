(* Rounding of the six-term form, the kernel of every triple's length (squared_length in combination_mae.hpp):
     q0*a*a + q1*b*b + q2*c*c + q3*a*b + q4*a*c + q5*b*c,  scalar, left to right, no fused multiply-add.
   binary64 as Flocq has it: 53 bits, smallest exponent -1074, round to nearest even. Overflow is not modelled: a form whose
   terms stay below 1e300 is far from it. Tested on the code with the same bound:
     constant kFormError_u 7.1 *)
From Coq Require Import ZArith Reals Lra Psatz.
From Flocq Require Import Core Relative Plus_error.
Open Scope R_scope.

Definition fexp := FLT_exp (-1074) 53.
Definition fl (x : R) : R := round radix2 fexp ZnearestE x.
Definition double (x : R) : Prop := generic_format radix2 fexp x.

Definition u : R := bpow radix2 (-53).        (* half a unit in the last place of 1 *)
Definition tiny : R := bpow radix2 (-1075).   (* half of the smallest positive number *)

Lemma u_value : u = / 9007199254740992.
Proof. unfold u. simpl. lra. Qed.
Lemma tiny_positive : 0 < tiny.
Proof. apply bpow_gt_0. Qed.

#[local] Instance prec_positive : Prec_gt_0 53 := eq_refl.

Lemma fl_double (x : R) : double (fl x).
Proof. apply generic_format_round; typeclasses eauto. Qed.

(* One operation: a relative error of at most u, and near zero at most [tiny] besides. *)
Lemma fl_error (x : R) : Rabs (fl x - x) <= u * Rabs x + tiny.
Proof.
  destruct (error_N_FLT radix2 (-1074) 53 ltac:(lia) (fun n => negb (Z.even n)) x) as [e [t [He [Ht [_ E]]]]].
  unfold fl, fexp. rewrite E.
  replace (x * (1 + e) + t - x) with (e * x + t) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult.
  apply Rplus_le_compat.
  - apply Rmult_le_compat_r; [apply Rabs_pos|]. apply Rle_trans with (1 := He). unfold u. simpl. lra.
  - apply Rle_trans with (1 := Ht). unfold tiny. change (-1075)%Z with (-1 + -1074)%Z. rewrite bpow_plus.
    change (bpow radix2 (-1)) with (/ 2). lra.
Qed.

(* A sum of two doubles has no error near zero. *)
Lemma sum_error (x y : R) : double x -> double y -> exists e, Rabs e <= u /\ fl (x + y) = (x + y) * (1 + e).
Proof.
  intros X Y. destruct (FLT_plus_error_N_ex radix2 (-1074) 53 (fun n => negb (Z.even n)) x y X Y) as [e [He E]].
  exists e. split; [|exact E]. apply Rle_trans with (1 := He).
  assert (u_ro radix2 53 = u) as -> by (unfold u_ro, u; simpl; lra).
  rewrite u_value. lra.
Qed.

(* One term q*a*b, computed (q*a)*b. *)
Lemma term_error (q a b : R) :
  Rabs b <= 1024 -> Rabs (fl (fl (q * a) * b) - q * a * b) <= 2001 / 1000 * u * Rabs (q * a * b) + 1030 * tiny.
Proof.
  intros B. pose proof (fl_error (q * a)) as X. set (x := fl (q * a)) in *.
  pose proof (fl_error (x * b)) as Y. set (y := fl (x * b)) in *.
  pose proof tiny_positive as T. pose proof u_value as U. pose proof (Rabs_pos b) as Pb.
  pose proof (Rabs_pos (q * a)) as Pqa.
  assert (Rabs x <= Rabs (q * a) * (1 + u) + tiny) as Xs.
  { pose proof (Rabs_triang (q * a) (x - q * a)) as R. replace (q * a + (x - q * a)) with x in R by ring. lra. }
  rewrite (Rabs_mult (q * a) b). rewrite Rabs_mult in Y.
  set (m := Rabs (q * a)) in *. set (beta := Rabs b) in *.
  assert (Rabs (y - q * a * b) <= Rabs (y - x * b) + beta * Rabs (x - q * a)) as Split.
  { replace (y - q * a * b) with ((y - x * b) + b * (x - q * a)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult. fold beta. lra. }
  assert (beta * Rabs (x - q * a) <= beta * (u * m + tiny)) as S1 by (apply Rmult_le_compat_l; [exact Pb|exact X]).
  assert (u * (Rabs x * beta) <= u * ((m * (1 + u) + tiny) * beta)) as S2.
  { apply Rmult_le_compat_l; [rewrite U; lra|]. now apply Rmult_le_compat_r. }
  apply Rle_trans with (1 := Split).
  apply Rle_trans with (u * ((m * (1 + u) + tiny) * beta) + tiny + beta * (u * m + tiny)); [lra|].
  replace (u * ((m * (1 + u) + tiny) * beta) + tiny + beta * (u * m + tiny))
    with ((2 + u) * u * (m * beta) + (1 + beta * (1 + u)) * tiny) by ring.
  assert (0 <= m * beta) by now apply Rmult_le_pos.
  apply Rplus_le_compat.
  - apply Rmult_le_compat_r; [assumption|]. rewrite U. lra.
  - apply Rmult_le_compat_r; [lra|]. assert (beta * (1 + u) <= 1024 * (1 + u)) by (apply Rmult_le_compat_r; [rewrite U|]; lra).
    rewrite U in *. lra.
Qed.

(* Adding the next term t of T to a partial sum s of S; A is the sum of the sizes so far. *)
Lemma add_error (s S A t T c p e : R) :
  Rabs S <= A -> Rabs (s - S) <= c * u * A + p -> Rabs (t - T) <= 2001 / 1000 * u * Rabs T + 1030 * tiny ->
  2001 / 1000 <= c <= 8 -> 0 <= p -> Rabs e <= u ->
  Rabs (S + T) <= A + Rabs T /\
  Rabs ((s + t) * (1 + e) - (S + T)) <= (c + 1001 / 1000) * u * (A + Rabs T) + 1001 / 1000 * (p + 1030 * tiny).
Proof.
  intros HS Hs Ht Hc Hp He. split; [apply Rle_trans with (1 := Rabs_triang _ _); lra|].
  pose proof tiny_positive as Tiny. pose proof u_value as U. pose proof (Rabs_pos T) as PT. pose proof (Rabs_pos S) as PS.
  set (B := A + Rabs T). set (d := p + 1030 * tiny).
  assert (0 <= B) as PB by (unfold B; lra). assert (0 <= d) as Pd by (unfold d; lra).
  assert (0 < u) as Pu by (rewrite U; lra).
  assert (Rabs ((s - S) + (t - T)) <= c * u * B + d) as Carried.
  { apply Rle_trans with (1 := Rabs_triang _ _).
    assert (2001 / 1000 * u * Rabs T <= c * u * Rabs T).
    { apply Rmult_le_compat_r; [exact PT|]. apply Rmult_le_compat_r; lra. }
    unfold B, d. rewrite Rmult_plus_distr_l. lra. }
  assert (Rabs (s + t) <= B * (1 + 8 * u) + d) as Size.
  { replace (s + t) with ((S + T) + ((s - S) + (t - T))) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    assert (Rabs (S + T) <= B) by (unfold B; apply Rle_trans with (1 := Rabs_triang _ _); lra).
    assert (c * u * B <= 8 * u * B) by (apply Rmult_le_compat_r; [exact PB|]; apply Rmult_le_compat_r; lra). lra. }
  replace ((s + t) * (1 + e) - (S + T)) with (((s - S) + (t - T)) + e * (s + t)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_mult e).
  assert (Rabs e * Rabs (s + t) <= u * (B * (1 + 8 * u) + d)) as Own
    by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
  apply Rle_trans with (c * u * B + d + u * (B * (1 + 8 * u) + d)); [lra|].
  replace (c * u * B + d + u * (B * (1 + 8 * u) + d)) with ((c + (1 + 8 * u)) * u * B + (1 + u) * d) by ring.
  apply Rplus_le_compat.
  - apply Rmult_le_compat_r; [exact PB|]. apply Rmult_le_compat_r; [lra|]. rewrite U. lra.
  - apply Rmult_le_compat_r; [exact Pd|]. rewrite U. lra.
Qed.

Lemma add_error_fl (s S A t T c p : R) :
  double s -> double t ->
  Rabs S <= A -> Rabs (s - S) <= c * u * A + p -> Rabs (t - T) <= 2001 / 1000 * u * Rabs T + 1030 * tiny ->
  2001 / 1000 <= c <= 8 -> 0 <= p ->
  Rabs (S + T) <= A + Rabs T /\
  Rabs (fl (s + t) - (S + T)) <= (c + 1001 / 1000) * u * (A + Rabs T) + 1001 / 1000 * (p + 1030 * tiny).
Proof.
  intros Ds Dt HS Hs Ht Hc Hp. destruct (sum_error s t Ds Dt) as [e [He ->]]. now apply add_error.
Qed.

(* The whole kernel, and what it stands for. *)
Definition kernel (q0 q1 q2 q3 q4 q5 a b c : R) : R :=
  fl (fl (fl (fl (fl (fl (fl (q0 * a) * a) + fl (fl (q1 * b) * b)) + fl (fl (q2 * c) * c)) + fl (fl (q3 * a) * b))
      + fl (fl (q4 * a) * c)) + fl (fl (q5 * b) * c)).
Definition form (q0 q1 q2 q3 q4 q5 a b c : R) : R :=
  q0 * a * a + q1 * b * b + q2 * c * c + q3 * a * b + q4 * a * c + q5 * b * c.
Definition form_size (q0 q1 q2 q3 q4 q5 a b c : R) : R :=
  Rabs (q0 * a * a) + Rabs (q1 * b * b) + Rabs (q2 * c * c) + Rabs (q3 * a * b) + Rabs (q4 * a * c) + Rabs (q5 * b * c).

(* The error is at most 7.1 units of 2^-53 of the sum of the sizes of the terms (and less than 1e-319 near zero), for all
   coefficients and all readings up to 1024 m/s^2 in size. *)
Theorem form_error (q0 q1 q2 q3 q4 q5 a b c : R) :
  Rabs a <= 1024 -> Rabs b <= 1024 -> Rabs c <= 1024 ->
  Rabs (kernel q0 q1 q2 q3 q4 q5 a b c - form q0 q1 q2 q3 q4 q5 a b c)
    <= 7.1 * u * form_size q0 q1 q2 q3 q4 q5 a b c + 7000 * tiny.
Proof.
  intros A B C. pose proof tiny_positive as Tiny. unfold kernel, form, form_size.
  pose proof (term_error q0 a a A) as T0. pose proof (term_error q1 b b B) as T1.
  pose proof (term_error q2 c c C) as T2. pose proof (term_error q3 a b B) as T3.
  pose proof (term_error q4 a c C) as T4. pose proof (term_error q5 b c C) as T5.
  set (t0 := fl (fl (q0 * a) * a)) in *. set (t1 := fl (fl (q1 * b) * b)) in *.
  set (t2 := fl (fl (q2 * c) * c)) in *. set (t3 := fl (fl (q3 * a) * b)) in *.
  set (t4 := fl (fl (q4 * a) * c)) in *. set (t5 := fl (fl (q5 * b) * c)) in *.
  assert (double t0 /\ double t1 /\ double t2 /\ double t3 /\ double t4 /\ double t5) as [D0 [D1 [D2 [D3 [D4 D5]]]]]
    by (repeat split; apply fl_double).
  destruct (add_error_fl _ _ _ _ _ _ _ D0 D1 (Rle_refl _) T0 T1 ltac:(lra) ltac:(lra)) as [S1 R1].
  destruct (add_error_fl _ _ _ _ _ _ _ (fl_double _) D2 S1 R1 T2 ltac:(lra) ltac:(lra)) as [S2 R2].
  destruct (add_error_fl _ _ _ _ _ _ _ (fl_double _) D3 S2 R2 T3 ltac:(lra) ltac:(lra)) as [S3 R3].
  destruct (add_error_fl _ _ _ _ _ _ _ (fl_double _) D4 S3 R3 T4 ltac:(lra) ltac:(lra)) as [S4 R4].
  destruct (add_error_fl _ _ _ _ _ _ _ (fl_double _) D5 S4 R4 T5 ltac:(lra) ltac:(lra)) as [S5 R5].
  apply Rle_trans with (1 := R5).
  assert (0 <= Rabs (q0 * a * a) + Rabs (q1 * b * b) + Rabs (q2 * c * c) + Rabs (q3 * a * b) + Rabs (q4 * a * c)
            + Rabs (q5 * b * c)) as P by (repeat apply Rplus_le_le_0_compat; apply Rabs_pos).
  apply Rplus_le_compat; [|lra]. apply Rmult_le_compat_r; [exact P|].
  apply Rmult_le_compat_r; [rewrite u_value|]; lra.
Qed.
