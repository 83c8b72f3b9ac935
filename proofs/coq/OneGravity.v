(* R2: one gravity for all stations of an episode (docs/theory.md, section 5.3). What a set reads as the length of gravity is
   known at station k within a margin m_k, and gravity itself within D of G. A set is contradicted if no one length within
   these bounds explains all of its stations. A healthy set is never contradicted while the acceleration stays within what
   the margins allow for, so no healthy sensor is isolated; beyond that bound a healthy set can be contradicted.
   The rule may rest at some stations (docs/theory.md says when): it then contradicts fewer sets, and what follows holds. *)
From Coq Require Import Reals Lra Arith Bool Lia Psatz.
From Plumb Require Import Sets Vectors Sensors Soundness.
Open Scope R_scope.

Section Lengths.
  Variables (G D : R) (K : nat).      (* gravity, what it may be off by, the number of stations *)
  Variables len m : nat -> R.         (* the length that the set reads at a station, and its margin *)

  (* L explains all stations. *)
  Definition explains_lengths (L : R) : Prop := Rabs (L - G) <= D /\ forall k, (k < K)%nat -> Rabs (L - len k) <= m k.
  Definition contradicted : Prop := ~ exists L, explains_lengths L.

  (* What the monitor keeps: the highest lower end and the lowest upper end of the intervals up to station k. *)
  Fixpoint low (k : nat) : R := match k with O => G - D | S j => Rmax (low j) (len j - m j) end.
  Fixpoint high (k : nat) : R := match k with O => G + D | S j => Rmin (high j) (len j + m j) end.

  Lemma between_ends k L :
    low k <= L <= high k <-> Rabs (L - G) <= D /\ forall j, (j < k)%nat -> Rabs (L - len j) <= m j.
  Proof.
    induction k; simpl.
    - split; [intros B; split; [apply Rabs_le; lra|intros; lia]|intros [A _]; apply Rabs_le_inv in A; lra].
    - split.
      + intros [Lo Hi]. pose proof (Rmax_l (low k) (len k - m k)). pose proof (Rmax_r (low k) (len k - m k)).
        pose proof (Rmin_l (high k) (len k + m k)). pose proof (Rmin_r (high k) (len k + m k)).
        destruct (proj1 IHk ltac:(lra)) as [A E]. split; [exact A|]. intros j Hj.
        destruct (Nat.eq_dec j k) as [->|Ne]; [apply Rabs_le; lra|apply E; lia].
      + intros [A E]. destruct (proj2 IHk) as [Lo Hi]; [split; [exact A|intros j Hj; apply E; lia]|].
        pose proof (Rabs_le_inv _ _ (E k ltac:(lia))). split; [apply Rmax_lub; lra|apply Rmin_glb; lra].
  Qed.

  (* The two ends decide: they are in order if and only if some length explains all stations. *)
  Theorem R2_interval_intersection : low K <= high K <-> exists L, explains_lengths L.
  Proof.
    split; [intros Le; exists (low K); apply between_ends; lra|]. intros [L E]. apply between_ends in E. lra.
  Qed.

  (* So the set is contradicted if and only if the ends have crossed, which is what the monitor asks. *)
  Theorem R2_contradicted_means_crossed : contradicted <-> high K < low K.
  Proof.
    unfold contradicted. rewrite <- R2_interval_intersection. split; [apply Rnot_le_lt|apply Rlt_not_le].
  Qed.

  (* Lengths at two stations that differ by more than both margins contradict the set, wherever gravity lies. *)
  Theorem R2_rejects_what_differs (j k : nat) :
    (j < K)%nat -> (k < K)%nat -> m j + m k < Rabs (len j - len k) -> contradicted.
  Proof.
    intros Hj Hk Far [L [_ E]]. pose proof (Rabs_le_inv _ _ (E j Hj)). pose proof (Rabs_le_inv _ _ (E k Hk)).
    apply (Rlt_not_le _ _ Far). apply Rabs_le. lra.
  Qed.
End Lengths.

(* What a healthy set reads is within e of the length felt; that is within A, the stated acceleration, of one length L, the
   same at all stations: gravity's, with what is off by one factor at all attitudes. So margins of e + A keep the set. *)
Theorem R2_healthy_set_is_kept (G D A L : R) (K : nat) (len felt e : nat -> R) :
  Rabs (L - G) <= D -> (forall k, (k < K)%nat -> Rabs (felt k - L) <= A) ->
  (forall k, (k < K)%nat -> Rabs (len k - felt k) <= e k) ->
  explains_lengths G D K len (fun k => e k + A) L /\ ~ contradicted G D K len (fun k => e k + A).
Proof.
  intros Near Felt Read. assert (explains_lengths G D K len (fun k => e k + A) L) as E.
  { split; [exact Near|]. intros k Hk. pose proof (Rabs_le_inv _ _ (Felt k Hk)). pose proof (Rabs_le_inv _ _ (Read k Hk)).
    apply Rabs_le. lra. }
  split; [exact E|]. intros C. apply C. now exists L.
Qed.

(* In vectors: the tool feels gravity g_k, of length L, plus an acceleration of at most A in any direction, and the set's
   estimate x_k is off from that by at most e_k. *)
Theorem R2_healthy_estimates_are_kept (G D A L : R) (K : nat) (g acc x : nat -> vec) (e : nat -> R) :
  Rabs (L - G) <= D -> (forall k, (k < K)%nat -> norm (g k) = L) -> (forall k, (k < K)%nat -> norm (acc k) <= A) ->
  (forall k, (k < K)%nat -> norm (vsub (x k) (vadd (g k) (acc k))) <= e k) ->
  ~ contradicted G D K (fun k => norm (x k)) (fun k => e k + A).
Proof.
  intros Near Length Acc Off.
  apply (R2_healthy_set_is_kept G D A L K _ (fun k => norm (vadd (g k) (acc k))) e); [exact Near| |]; intros k Hk.
  - rewrite <- (Length k Hk). apply Rle_trans with (1 := norm_add_close _ _). now apply Acc.
  - pose proof (norm_add_close (vadd (g k) (acc k)) (vsub (x k) (vadd (g k) (acc k)))) as Close.
    replace (vadd (vadd (g k) (acc k)) (vsub (x k) (vadd (g k) (acc k)))) with (x k) in Close by vec_ring.
    apply Rle_trans with (1 := Close). now apply Off.
Qed.

(* Why the acceleration must be stated. Gravity is exactly G, and the set reads exactly what the tool feels: gravity plus an
   acceleration a along it at station 0, against it at station 1. If a is more than A by more than e, however little, the
   set is contradicted at margins of e + A, though all of its sensors are healthy. *)
Theorem R2_needs_the_stated_acceleration (G D A e a : R) :
  0 <= A -> 0 <= e -> A + e < a -> a <= G ->
  exists g acc : nat -> vec, (forall k, norm (g k) = G /\ norm (acc k) = a) /\
    contradicted G D 2 (fun k => norm (vadd (g k) (acc k))) (fun _ => e + A).
Proof.
  intros PA Pe Big Le. exists (fun _ => V 0 0 G), (fun k => match k with O => V 0 0 a | _ => V 0 0 (- a) end).
  assert (forall z, norm (V 0 0 z) = Rabs z) as N.
  { intros z. rewrite <- sqrt_Rsqr_abs. unfold norm, Rsqr. f_equal. vec_unfold. ring. }
  split.
  - intros [|k]; rewrite !N; [|rewrite Rabs_Ropp]; rewrite !Rabs_pos_eq by lra; lra.
  - apply (R2_rejects_what_differs _ _ _ _ _ 0 1); [lia|lia|]. unfold vadd. simpl. rewrite !Rplus_0_r, !N.
    rewrite (Rabs_pos_eq (G + a)), (Rabs_pos_eq (G + - a)) by lra. rewrite Rabs_pos_eq; lra.
Qed.

(* T5 with this rule: a set is alive if it is alive throughout (noise and systematic errors within eps, lengths within D + A
   of G) and one gravity explains its lengths. [len S k] is what the set S reads at station k, whatever makes it of the
   readings; its error [e S k] is asked for healthy sets only. *)
Section Episode.
  Variables (n : nat) (h : nat -> vec) (eps D A G : R) (K : nat) (y : nat -> nat -> R) (len e : set -> nat -> R).

  Definition alive_with_one_gravity (S : set) : Prop :=
    alive_throughout n h eps (D + A) G (fun k => (k < K)%nat) y S /\ ~ contradicted G D K (len S) (fun k => e S k + A).

  (* g k is what the tool feels at station k, its acceleration included. Nothing is said of the sensors outside of S0. *)
  Variables (g : nat -> vec) (L : R) (S0 : set).
  Hypothesis one_gravity : Rabs (L - G) <= D.
  Hypothesis stated_acceleration : forall k, (k < K)%nat -> Rabs (norm (g k) - L) <= A.
  Hypothesis healthy : forall k i, (k < K)%nat -> (i < n)%nat -> S0 i = true -> Rabs (dot (h i) (g k) - y k i) <= eps.

  Lemma healthy_set_is_alive (S : set) :
    subset n S S0 -> (forall k, (k < K)%nat -> Rabs (len S k - norm (g k)) <= e S k) -> alive_with_one_gravity S.
  Proof.
    intros Sub Read. split.
    - intros k Hk. exists (g k). pose proof (Rabs_le_inv _ _ one_gravity).
      pose proof (Rabs_le_inv _ _ (stated_acceleration k Hk)). split; [apply Rabs_le; lra|].
      intros i Hi Si. apply healthy; [exact Hk|exact Hi|]. now apply Sub.
    - now apply (R2_healthy_set_is_kept G D A L K (len S) (fun k => norm (g k)) (e S)).
  Qed.

  (* With at most m sensors that are not healthy throughout, nobody healthy is accused. *)
  Theorem R2_never_the_healthy (m : nat) :
    (forall k, (k < K)%nat -> Rabs (len S0 k - norm (g k)) <= e S0 k) ->
    (card n (compl S0) <= m)%nat -> forall i, S0 i = true -> ~ accused n alive_with_one_gravity m i.
  Proof.
    intros Read Few. apply (T5_never_the_healthy n); [|exact Few].
    apply healthy_set_is_alive; [|exact Read]. intros i _ Si. exact Si.
  Qed.

  (* The same for the fast form, which asks the sets of c + 1 sensors only. Parts of a set that is alive may be contradicted
     by their own lengths, so T5's fast form does not serve here; parts of a healthy set are healthy, and that is enough. *)
  Theorem R2_never_the_healthy_by_voting_sets (c : nat) :
    (forall S k, subset n S S0 -> card n S = (c + 1)%nat -> (k < K)%nat -> Rabs (len S k - norm (g k)) <= e S k) ->
    (c + 1 <= card n S0)%nat -> forall i, (i < n)%nat -> S0 i = true ->
    exists S, alive_with_one_gravity S /\ card n S = (c + 1)%nat /\ S i = true.
  Proof.
    intros Read Many i Hi Si. destruct (subset_of_size_with n S0 i (c + 1) Hi Si ltac:(lia)) as [B [Sub [Size Bi]]].
    exists B. split; [|now split]. apply healthy_set_is_alive; [exact Sub|]. intros k Hk. now apply Read.
  Qed.
End Episode.
