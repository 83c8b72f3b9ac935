(* T17: parity of gyro axes. A rate has no length that is known, so of the answers to T1..T16 only parity is left (T11, T12); this
   file states what an axis may be off by, which is all that parity needs; what a rate near zero at rest adds; and that while no
   four axes contradict one another nothing is said against any of them, whatever they read at rest. *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors Sensors Helly ParitySums Quads Motion.
Open Scope R_scope.

(* What an axis reads of the rate w: by its own axis and scale, g; a bias b; and k, what a specific force and a delay do to it. Its
   nominal axis is h; g is within rho of it: an error of scale along it, one of the axis across it. *)
Definition reads_rate (g w : vec) (b k y : R) : Prop := y = dot g w + b + k.

Lemma dot_within (d w : vec) (rho W : R) : norm d <= rho -> norm w <= W -> Rabs (dot d w) <= rho * W.
Proof.
  intros Hd Hw. pose proof (norm_nonneg d). pose proof (norm_nonneg w).
  assert (norm d * norm w <= rho * W) by (apply Rmult_le_compat; lra).
  pose proof (cauchy_schwarz d w). pose proof (cauchy_schwarz (scale (-1) d) w) as C.
  rewrite norm_scale, (Rabs_left (-1)) in C by lra. replace (- -1 * norm d) with (norm d) in C by ring.
  replace (dot (scale (-1) d) w) with (- dot d w) in C by (unfold dot, scale; simpl; ring).
  apply Rabs_le. lra.
Qed.

(* The limit of an axis that turns by no more than W: T11 with this for the errors of the readings is sound for rates. *)
Theorem T17_error_of_an_axis (h g w : vec) (b k y rho W B K : R) :
  reads_rate g w b k y -> norm (vsub g h) <= rho -> norm w <= W -> Rabs b <= B -> Rabs k <= K ->
  Rabs (y - dot h w) <= rho * W + B + K.
Proof.
  intros -> Hg Hw Hb Hk. replace (dot g w + b + k - dot h w) with (dot (vsub g h) w + b + k)
    by (unfold dot, vsub; simpl; ring).
  pose proof (dot_within _ _ _ _ Hg Hw). pose proof (Rabs_triang (dot (vsub g h) w + b) k).
  pose proof (Rabs_triang (dot (vsub g h) w) b). lra.
Qed.

(* A healthy set of gyro axes is not rejected, whatever the tool turns by within the bound. *)
Theorem T17_parity_of_rates (n : nat) (h g : nat -> vec) (q W : R) (rho B K : nat -> R) (Q : set) (v y nu b k : nat -> R) (w : vec) :
  parity n h Q v -> norm w <= W -> Rabs (along n Q v nu) <= q ->
  (forall i, (i < n)%nat -> Q i = true -> reads_rate (g i) w (b i) (k i) (y i - nu i)) ->
  (forall i, (i < n)%nat -> Q i = true -> norm (vsub (g i) (h i)) <= rho i /\ Rabs (b i) <= B i /\ Rabs (k i) <= K i) ->
  ~ rejected n q Q v (fun i => rho i * W + B i + K i) y.
Proof.
  intros Null Hw Noise Read Bounds.
  apply (T11_parity_in_motion n h q Q v (fun i => rho i * W + B i + K i) y nu (fun i => y i - nu i - dot (h i) w) w Null);
    [intros; ring| |exact Noise].
  intros i Hi Qi. destruct (Bounds i Hi Qi) as [Hg [Hb Hk]].
  now apply (T17_error_of_an_axis (h i) (g i) w (b i) (k i)); [apply Read| | | |].
Qed.

(* At rest the tool turns by no more than W, the Earth's rate: a healthy axis reads no more than this. *)
Theorem T17_at_rest (h g w : vec) (b k y rho W B K : R) :
  reads_rate g w b k y -> norm h = 1 -> norm (vsub g h) <= rho -> norm w <= W -> Rabs b <= B -> Rabs k <= K ->
  Rabs y <= (1 + rho) * W + B + K.
Proof.
  intros Read H1 Hg Hw Hb Hk. pose proof (T17_error_of_an_axis h g w b k y rho W B K Read Hg Hw Hb Hk).
  assert (Rabs (dot h w) <= 1 * W) by (apply dot_within; lra).
  pose proof (Rabs_triang (y - dot h w) (dot h w)) as T. replace (y - dot h w + dot h w) with y in T by ring. lra.
Qed.

(* A tool that turns although it is said to rest: every axis is healthy, parity is silent, and readings are as large as one likes.
   So what reads too much at rest is not blamed for that alone. *)
Theorem T17_a_turn_is_no_fault (n : nat) (h : nat -> vec) (Q : set) (v : nat -> R) (w : vec) (s : R) :
  parity n h Q v -> along n Q v (fun i => dot (h i) (scale s w)) = 0.
Proof. intros Null. apply Null. Qed.

(* While of every four axes one rate explains the readings within their limits, one explains all of them: no axis need be faulty.
   Four axes have none exactly where their parity is rejected (T6_one_four). *)
Theorem T17_one_rate_explains_all (n : nat) (h : nat -> vec) (y e : nat -> R) : (4 <= n)%nat ->
  (forall i j k l, (i < j)%nat -> (j < k)%nat -> (k < l)%nat -> (l < n)%nat ->
    exists x, slab (h i) (y i) (e i) x /\ slab (h j) (y j) (e j) x /\ slab (h k) (y k) (e k) x /\ slab (h l) (y l) (e l) x) ->
  exists x, forall i, (i < n)%nat -> slab (h i) (y i) (e i) x.
Proof.
  intros Hn. apply (helly_in_space n (fun i => slab (h i) (y i) (e i)) Hn). intros i. apply slab_convex.
Qed.

(* So n axes of units of their own isolate one that is faulty among up to n - 4 in general position (c = 2), and blame nobody
   else, whatever the rate: T11 with nothing known of the length. *)
Theorem T17_isolable (n m i : nat) (h : nat -> vec) (w : vec) (f : nat -> R) :
  at_most_coplanar n h 2 -> (1 <= m)%nat -> (m + 4 <= n)%nat -> (i < n)%nat -> only_fault n i f ->
  forall j, (j < n)%nat -> (accused_by_parity n h (readings h w f) m j <-> j = i).
Proof. intros Cop Pm Few. apply (T11_isolable_in_motion n h 2 m i w f Cop Pm). lia. Qed.
