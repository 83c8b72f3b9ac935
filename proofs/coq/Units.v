(* T12: chips as fault units. The axes of a chip share its supply, clock and solder, and fail together; so a fault set is a
   union of chips (units), and m counts units. The rule that never isolates a healthy sensor holds for units as it does for
   sensors; for k parallel triads its limits are k >= 2m + 1 by parity, and for two triads what the length adds.
   The monitor does not isolate by units yet. *)
From Coq Require Import Reals Lra Arith Bool Lia.
From Plumb Require Import Sets Vectors Sensors Soundness.
Open Scope R_scope.

(* Sensor i belongs to unit [unit_of i], one of k. A set U of units stands for all of their sensors. *)
Definition sensors (unit_of : nat -> nat) (U : set) : set := fun i => U (unit_of i).

Section Units.
  Variables (n k : nat) (unit_of : nat -> nat).
  Variable alive : set -> Prop.    (* the sets of sensors that no test has rejected *)

  (* Unit u is in every consistent fault set of at most m units; the fault set is what U leaves out. *)
  Definition unit_isolated (m u : nat) : Prop :=
    forall U, alive (sensors unit_of U) -> (card k (compl U) <= m)%nat -> compl U u = true.

  (* H, the healthy units, leave out at most m, and the set of their sensors is alive: none of them is isolated. *)
  Theorem T12_never_the_healthy (m : nat) (H : set) :
    alive (sensors unit_of H) -> (card k (compl H) <= m)%nat -> forall u, H u = true -> ~ unit_isolated m u.
  Proof.
    intros A Few u Hu Iso. apply (T5_never_the_healthy k (fun U => alive (sensors unit_of U)) m H A Few u Hu).
    now apply accused_is_in_every_live_fault_set.
  Qed.

  (* Where parts of a live set are alive, it is enough that the healthy sensors S0 are alive together: a unit is healthy if all
     of its sensors are, and the units that are not, by one axis or by all three, are at most m. *)
  Theorem T12_never_the_healthy_by_sensors (m : nat) (S0 H : set) :
    (forall A B, alive A -> subset n B A -> alive B) -> alive S0 ->
    (forall i, (i < n)%nat -> H (unit_of i) = true -> S0 i = true) -> (card k (compl H) <= m)%nat ->
    forall u, H u = true -> ~ unit_isolated m u.
  Proof. intros Hereditary A Whole. apply T12_never_the_healthy. now apply (Hereditary S0). Qed.
End Units.

(* k triads of the same three independent axes a, b, c: sensors 3u, 3u + 1, 3u + 2 are unit u. It reads a vector of its own. *)
Section Triads.
  Variables a b c : vec.
  Hypothesis independent : det a b c <> 0.

  Definition axis (i : nat) : vec := match (i mod 3)%nat with 0%nat => a | 1%nat => b | _ => c end.
  Definition chip (i : nat) : nat := (i / 3)%nat.
  Definition vector_of (y : nat -> R) (u : nat) : vec :=
    vadd (scale (y (3 * u)%nat) (dual a b c))
      (vadd (scale (y (3 * u + 1)%nat) (dual b c a)) (scale (y (3 * u + 2)%nat) (dual c a b))).
  Definition agree (k : nat) (U : set) (X : nat -> vec) : Prop := exists x, forall u, (u < k)%nat -> U u = true -> X u = x.

  Lemma reads_a_vector y u x : vector_of y u = x <->
    dot a x = y (3 * u)%nat /\ dot b x = y (3 * u + 1)%nat /\ dot c x = y (3 * u + 2)%nat.
  Proof.
    split.
    - intros <-. unfold vector_of. pose proof independent as D1. rewrite <- det_rotate in D1.
      pose proof D1 as D2. rewrite <- det_rotate in D2.
      rewrite !dot_add_r, !dot_scale_r, !dual_self, !dual_second, !dual_third by assumption. lra.
    - intros [A [B C]]. unfold vector_of. rewrite <- A, <- B, <- C. symmetry. now apply dual_expand.
  Qed.

  (* Parity between the chips is agreement of these vectors: one vector explains all sensors of U if and only if the units of
     U read the same. *)
  Theorem T12_parity_is_agreement (k : nat) (U : set) (y : nat -> R) :
    consistent (3 * k) axis (sensors chip U) y <-> agree k U (vector_of y).
  Proof.
    assert (forall u r, (r < 3)%nat -> ((3 * u + r) / 3 = u /\ (3 * u + r) mod 3 = r)%nat) as Part.
    { intros u r Hr. split; symmetry; [apply (Nat.div_unique _ 3 u r)|apply (Nat.mod_unique _ 3 u r)]; lia. }
    split; intros [x E]; exists x.
    - intros u Hu Uu. apply reads_a_vector.
      assert (forall r, (r < 3)%nat -> dot (axis (3 * u + r)) x = y (3 * u + r)%nat) as Row.
      { intros r Hr. apply E; [lia|]. unfold sensors, chip. now rewrite (proj1 (Part u r Hr)). }
      pose proof (Row 0%nat ltac:(lia)) as A. pose proof (Row 1%nat ltac:(lia)) as B. pose proof (Row 2%nat ltac:(lia)) as C.
      unfold axis in A, B, C. rewrite (proj2 (Part u 0%nat ltac:(lia))), Nat.add_0_r in A.
      rewrite (proj2 (Part u 1%nat ltac:(lia))) in B. rewrite (proj2 (Part u 2%nat ltac:(lia))) in C. tauto.
    - intros i Hi Ui. pose proof (Nat.div_mod i 3 ltac:(lia)) as Di. pose proof (Nat.mod_upper_bound i 3 ltac:(lia)).
      specialize (E (i / 3)%nat ltac:(lia) Ui). apply reads_a_vector in E as [A [B C]]. rewrite Di at 2. unfold axis.
      destruct (i mod 3)%nat as [|[|[|r]]]; [rewrite Nat.add_0_r; exact A|exact B|exact C|lia].
  Qed.
End Triads.

Lemma a_member (n : nat) (A : set) : (0 < card n A)%nat -> exists i, (i < n)%nat /\ A i = true.
Proof.
  induction n; simpl; intros P; [lia|]. destruct (A n) eqn:An; [exists n; split; [lia|exact An]|].
  destruct IHn as [i [Hi Ai]]; [lia|]. exists i. split; [lia|exact Ai].
Qed.

(* The first m of n. *)
Definition first (m : nat) : set := fun u => Nat.ltb u m.
Lemma card_first (n m : nat) : card n (first m) = Nat.min n m.
Proof. induction n; [reflexivity|]. simpl card. rewrite IHn. unfold first at 1. destruct (Nat.ltb_spec n m); lia. Qed.

(* Worst case. Unit u reads g + F u; it is healthy if its fault F u, a vector, is zero. *)
Section WorstCase.
  Variable k : nat.
  Definition reads (g : vec) (F : nat -> vec) (u : nat) : vec := vadd g (F u).
  Definition healthy_units (H : set) (F : nat -> vec) : Prop := forall u, (u < k)%nat -> (H u = true <-> F u = vzero).

  Lemma healthy_reads (g : vec) (F : nat -> vec) (u : nat) : reads g F u = g <-> F u = vzero.
  Proof.
    unfold reads. split; intros E.
    - apply vec_eq; [apply (f_equal vx) in E|apply (f_equal vy) in E|apply (f_equal vz) in E]; simpl in *; lra.
    - rewrite E. vec_ring.
  Qed.

  (* k >= 2m + 1 is enough: units that agree and are at least as many as the healthy ones are the healthy ones. No length. *)
  Theorem T12_triads_sufficient (m : nat) (g : vec) (F : nat -> vec) (H U : set) :
    healthy_units H F -> (card k (compl H) <= m)%nat -> (2 * m + 1 <= k)%nat ->
    agree k U (reads g F) -> (card k H <= card k U)%nat -> same k U H.
  Proof.
    intros He Few Big [x E] Le. pose proof (card_compl k H). pose proof (card_overlap k U H).
    destruct (a_member k (inter U H) ltac:(lia)) as [u [Hu Both]]. apply andb_prop in Both as [Uu Hh].
    assert (x = g) as ->.
    { rewrite <- (E u Hu Uu). apply healthy_reads. now apply He. }
    apply subset_same; [|exact Le]. intros w Hw Uw. apply He; [exact Hw|]. apply (healthy_reads g). now apply E.
  Qed.

  (* Any split of the units in two: the same readings come from g with one part faulty and from g' with the other. *)
  Lemma two_parts (g g' : vec) (H : set) : g <> g' -> exists F F', healthy_units H F /\ healthy_units (compl H) F' /\
    forall u, reads g F u = reads g' F' u.
  Proof.
    intros Ne. exists (fun u => if H u then vzero else vsub g' g), (fun u => if H u then vsub g g' else vzero).
    assert (forall p r, vsub p r = vzero -> p = r) as Equal.
    { intros p r Z. apply vec_eq; [apply (f_equal vx) in Z|apply (f_equal vy) in Z|apply (f_equal vz) in Z]; simpl in *; lra. }
    split; [|split]; unfold compl, reads; intros u; [intros _|intros _|]; destruct (H u); simpl; split || vec_ring; try easy;
      intros Z; apply Equal in Z; congruence.
  Qed.
End WorstCase.

(* With k = 2m, two halves that read any two different vectors (of gravity's length or not) fit two explanations of m faulty
   units each. Two chips (m = 1): they differ, and parity does not tell which one is wrong. *)
Theorem T12_two_chips_cannot_tell (m : nat) (g g' : vec) : g <> g' -> exists F F' H,
  (forall u, reads g F u = reads g' F' u) /\ healthy_units (2 * m) H F /\ healthy_units (2 * m) (compl H) F' /\
  card (2 * m) (compl H) = m /\ card (2 * m) (compl (compl H)) = m.
Proof.
  intros Ne. destruct (two_parts (2 * m) g g' (first m) Ne) as [F [F' [A [B Same]]]]. exists F, F', (first m).
  pose proof (card_first (2 * m) m). pose proof (card_compl (2 * m) (first m)).
  pose proof (card_compl (2 * m) (compl (first m))). repeat split; try assumption; try lia; try now apply A. all: now apply B.
Qed.

(* Isolation in the worst case, the length known: the largest set of units that agree on a vector of length G is unique and is
   the healthy one, whatever at most m units read. *)
Definition units_isolable (k : nat) (G : R) (m : nat) : Prop :=
  forall g F H U, norm2 g = G * G -> healthy_units k H F -> (card k (compl H) <= m)%nat ->
  (exists x, norm2 x = G * G /\ forall u, (u < k)%nat -> U u = true -> reads g F u = x) ->
  (card k H <= card k U)%nat -> same k U H.

Theorem T12_triads_worst_case (k : nat) (G : R) (m : nat) :
  0 < G -> (1 <= k)%nat -> (units_isolable k G m <-> (2 * m + 1 <= k)%nat).
Proof.
  intros PG Pk. split.
  - intros Iso. destruct (le_lt_dec (2 * m + 1) k) as [L|L]; [exact L|]. exfalso.
    set (H := first (k / 2)). pose proof (card_first k (k / 2)) as CH. fold H in CH.
    pose proof (Nat.div_mod k 2 ltac:(lia)). pose proof (Nat.mod_upper_bound k 2 ltac:(lia)). pose proof (card_compl k H).
    assert (V G 0 0 <> V (- G) 0 0) as Ne by (intros E; injection E; lra).
    destruct (two_parts k _ _ H Ne) as [F [F' [A [B Same]]]].
    assert (same k (compl H) H) as Wrong.
    { apply (Iso (V G 0 0) F); [vec_unfold; ring|exact A|lia| |lia]. exists (V (- G) 0 0). split; [vec_unfold; ring|].
      intros u Hu Uu. rewrite Same. apply healthy_reads. now apply B. }
    specialize (Wrong 0%nat ltac:(lia)). unfold compl in Wrong. now destruct (H 0%nat).
  - intros Big g F H U _ He Few [x [_ E]]. apply (T12_triads_sufficient k m g F H U He Few Big). now exists x.
Qed.

(* Two triads at rest: gravity's length is within d of G, and a healthy unit reads gravity within e (d = e = 0: exactly).
   A fault set F fits if one vector of that length explains the units outside of F. *)
Section Two.
  Variables G d e : R.
  Hypothesis e_positive : 0 <= e.
  Definition fits (X : nat -> vec) (F : set) : Prop :=
    exists x, Rabs (norm x - G) <= d /\ forall u, (u < 2)%nat -> F u = false -> norm (vsub (X u) x) <= e.

  (* The other unit, w, is healthy, and the length of u is off by more than both bounds: with at most one faulty unit, u is. *)
  Theorem T12_length_names_of_two (X : nat -> vec) (g : vec) (u w : nat) :
    (u < 2)%nat -> (w < 2)%nat -> u <> w -> Rabs (norm g - G) <= d -> norm (vsub (X w) g) <= e ->
    d + e < Rabs (norm (X u) - G) -> forall F, (card 2 F <= 1)%nat -> (fits X F <-> same 2 F (single u)).
  Proof.
    intros Hu Hw Ne Len Close Off F One. split.
    - intros [x [Lx Ex]]. assert (F u = true) as Fu.
      { destruct (F u) eqn:Fu; [reflexivity|]. exfalso. specialize (Ex u Hu Fu).
        pose proof (norm_add_close x (vsub (X u) x)) as C.
        replace (vadd x (vsub (X u) x)) with (X u) in C by vec_ring.
        pose proof (Rabs_triang (norm (X u) - norm x) (norm x - G)) as T.
        replace (norm (X u) - norm x + (norm x - G)) with (norm (X u) - G) in T by ring. lra. }
      simpl in One. intros i Hi. unfold single.
      destruct u as [|[|u]], w as [|[|w]], i as [|[|i]]; try lia; simpl; destruct (F 0%nat), (F 1%nat); easy || lia.
    - intros Same. exists g. split; [exact Len|]. intros i Hi Fi. replace i with w; [exact Close|].
      rewrite Same in Fi by exact Hi. unfold single in Fi. destruct (Nat.eqb_spec u i); [discriminate Fi|lia].
  Qed.

  (* A chip mounted turned: it reads gravity turned by a rotation, the columns p, q, s of which are of length 1 and at right
     angles (mirrors included). *)
  Variables p q s : vec.
  Hypothesis turning : norm2 p = 1 /\ norm2 q = 1 /\ norm2 s = 1 /\ dot p q = 0 /\ dot p s = 0 /\ dot q s = 0.
  Definition turn (x : vec) : vec := vadd (scale (vx x) p) (vadd (scale (vy x) q) (scale (vz x) s)).

  Lemma turn_keeps_length (x : vec) : norm (turn x) = norm x.
  Proof.
    destruct turning as [P [Q [S [PQ [PS QS]]]]]. unfold norm. f_equal. unfold turn.
    transitivity (vx x * vx x * norm2 p + vy x * vy x * norm2 q + vz x * vz x * norm2 s
      + 2 * (vx x * vy x * dot p q + vx x * vz x * dot p s + vy x * vz x * dot q s)); [vec_unfold; ring|].
    rewrite P, Q, S, PQ, PS, QS. vec_unfold. ring.
  Qed.

  (* The length does not tell: at all stations together either chip alone may be the faulty one. That one is, is seen wherever
     the turn moves gravity by more than both errors. *)
  Theorem T12_turned_chip_of_two (X : nat -> nat -> vec) (g : nat -> vec) (u w : nat) :
    (u < 2)%nat -> (w < 2)%nat -> u <> w ->
    (forall t, Rabs (norm (g t) - G) <= d /\ X t u = turn (g t) /\ X t w = g t) ->
    (forall t, fits (X t) (single u)) /\ (forall t, fits (X t) (single w)) /\
    (forall t, 2 * e < norm (vsub (turn (g t)) (g t)) -> forall F, F u = false -> F w = false -> ~ fits (X t) F).
  Proof.
    intros Hu Hw Ne Read. assert (forall x, norm (vsub x x) <= e) as Self.
    { intros x. apply norm_le; [exact e_positive|]. vec_unfold. nra. }
    repeat split; intros t; destruct (Read t) as [Len [Xu Xw]].
    - exists (g t). split; [exact Len|]. intros i Hi Fi. unfold single in Fi.
      destruct (Nat.eqb_spec u i); [discriminate Fi|]. replace i with w by lia. rewrite Xw. apply Self.
    - exists (turn (g t)). rewrite turn_keeps_length. split; [exact Len|]. intros i Hi Fi. unfold single in Fi.
      destruct (Nat.eqb_spec w i); [discriminate Fi|]. replace i with u by lia. rewrite Xu. apply Self.
    - intros Far F Fu Fw [x [_ E]]. pose proof (E u Hu Fu) as A. pose proof (E w Hw Fw) as B. rewrite Xu in A. rewrite Xw in B.
      pose proof (norm_triangle (vsub (turn (g t)) x) (scale (-1) (vsub (g t) x))) as T.
      rewrite norm_scale, Rabs_left in T by lra.
      replace (vadd (vsub (turn (g t)) x) (scale (-1) (vsub (g t) x))) with (vsub (turn (g t)) (g t)) in T by vec_ring. lra.
  Qed.
End Two.
