(* The state machine, over the very table that runs in the monitor: Table.v is generated from it at check time. The property
   names are those of the design. Facts that resolve a conditional target (what is left in service, whether trust is
   enough passed blocks, ...) are free here: whatever they are, the theorems hold. Only "a calibration was accepted" is tracked. *)
From Coq Require Import List Bool.
Import ListNotations.
From Plumb Require Import Table.

Record facts := Facts { size_left : size; not_yet_validated : bool; enough_passed : bool; from_suspect : bool; within : bool }.

Definition kind_of (m : mode) (e : event) : kind := fst (fst (cell m e)).
Definition target_of (m : mode) (e : event) : target := snd (fst (cell m e)).
Definition does (m : mode) (e : event) (a : action) : Prop := In a (snd (cell m e)).

Definition goes (m : mode) (e : event) (calibrated : bool) (f : facts) : mode :=
  match resolution (target_of m e) (size_left f) (not_yet_validated f) (enough_passed f) (from_suspect f) (within f) calibrated with
  | Some there => there
  | None => m
  end.

(* Decides a statement by running through every mode and every event, and through the facts where they matter. *)
Ltac in_list := simpl; repeat (first [left; reflexivity | right]).
Ltac settle := try solve [ reflexivity | discriminate | tauto | intuition congruence ].
Ltac every_cell := intros m e; destruct m, e; unfold does, goes, kind_of, target_of; simpl; intros; settle.
Ltac every_fact :=
  repeat match goal with f : facts |- _ => destruct f end; simpl in *; settle;
  repeat match goal with s : size |- _ => destruct s; simpl in *; settle end;
  repeat match goal with b : bool |- _ => destruct b; simpl in *; settle end.

(* S11 (its part in the table): every event has one cell in every mode. That [cell] and [resolution] are accepted as
   functions is the proof: a missing or doubled row does not compile. Cells that do nothing do nothing. *)
Theorem S11_idle_cells m e c f :
  kind_of m e = K_ignored \/ kind_of m e = K_held -> goes m e c f = m /\ forall a, ~ does m e a.
Proof. revert m e. every_cell; destruct H; settle; split; settle. Qed.

Theorem S11_impossible_cells_fail m e c f :
  kind_of m e = K_impossible -> goes m e c f = M_failed /\ forall a, ~ does m e a.
Proof. revert m e. every_cell. Qed.

(* What `plumb model` prints as "leads to" is what the targets resolve to, neither more nor less. *)
Definition all_facts : list (bool * facts) :=
  flat_map (fun s => flat_map (fun u => flat_map (fun r => flat_map (fun b => flat_map (fun w =>
    map (fun c => (c, Facts s u r b w)) [true; false]) [true; false]) [true; false]) [true; false]) [true; false]) all_sizes.
Scheme Equality for mode.
Definition among (m : mode) (l : list mode) : bool := existsb (mode_beq m) l.
Theorem printed_destinations_are_exact :
  forallb (fun m => forallb (fun e =>
    forallb (fun cf => among (goes m e (fst cf) (snd cf)) (leads_to m e)) all_facts &&
    forallb (fun there => among there (map (fun cf => goes m e (fst cf) (snd cf)) all_facts)) (leads_to m e))
    all_events) all_modes = true.
Proof. vm_compute. reflexivity. Qed.

(* S3: when a channel is lost, a culprit excluded or a sensor set aside and the rest no longer spans three directions, the monitor fails, in
   whatever mode it was (in failed it stays). *)
Theorem S3_rank_loss_fails m e c f :
  e = E_channel_lost \/ e = E_exclusion \/ e = E_provisional_exclusion -> size_left f = S_rank_lost -> goes m e c f = M_failed.
Proof. revert m e. every_cell; destruct H as [H|[H|H]]; settle; every_fact. Qed.

(* S3, the other side: nothing that goes "by size" arrives in service without rank. *)
Theorem S3_never_in_service_by_size m e c f :
  size_left f = S_rank_lost -> goes m e c f <> m ->
  goes m e c f <> M_nominal /\ goes m e c f <> M_isolated /\ goes m e c f <> M_degraded.
Proof. revert m e. every_cell; every_fact. Qed.

(* S6, S7: a sensor is excluded by an exclusion event only and provisionally excluded by a provisional_exclusion event only; only a lost channel is
   marked absent. So no alarm, no_consistent_hypothesis, norm_mismatch, motion or timeout takes a sensor out. *)
Theorem S6_S7_who_takes_sensors_out m e :
  (does m e A_exclude -> e = E_exclusion) /\ (does m e A_exclude_provisionally -> e = E_provisional_exclusion) /\
  (does m e A_mark_absent -> e = E_channel_lost).
Proof. revert m e. every_cell; repeat split; intuition discriminate. Qed.

(* S7: confirmed exclusion never from motion, failed never from motion. What a monitor in motion raises is an alarm or a
   provisional exclusion, leads to suspect, and takes sensors out provisionally at most. An exclusion that leaves no rank is
   not heeded (decide in the code, held against this by the lock-step model and the induction). *)
Definition heeds (m : mode) (e : event) (f : facts) : bool :=
  from_motion m e && match e, size_left f with E_provisional_exclusion, S_rank_lost => false | _, _ => true end.
Theorem S7_motion_decides_nothing_for_good m e c f :
  heeds m e f = true ->
  kind_of m e = K_taken /\ (e = E_alarm \/ e = E_provisional_exclusion) /\ goes m e c f = M_suspect /\
  forall a, does m e a -> a = A_exclude_provisionally \/ a = A_count.
Proof. unfold heeds. revert m e. every_cell; every_fact; repeat split; settle; intuition congruence. Qed.
Theorem S7_recalibration_and_failed_hear_no_motion m e f :
  state_of m = St_recalibrating \/ state_of m = St_failed -> heeds m e f = false.
Proof. unfold heeds. revert m e. every_cell; destruct H; settle. Qed.

(* S8: a fit is adopted on its acceptance only, out of recalibration only; the monitor is then suspect and not yet validated. *)
Theorem S8_adoption m e c f :
  does m e A_adopt_fit ->
  e = E_fit_accepted /\ state_of m = St_recalibrating /\ does m e A_not_yet_validated /\ goes m e c f = M_suspect.
Proof. revert m e. every_cell; repeat split; intuition discriminate. Qed.

(* S8, S16: while stations are being collected, whatever speaks against the data throws the collection away. *)
Definition speaks_against (e : event) : Prop :=
  In e [E_alarm; E_no_consistent_hypothesis; E_norm_mismatch; E_exclusion; E_provisional_exclusion; E_channel_lost; E_isolation_timeout].
Theorem S8_S16_nothing_survives_an_alarm m e :
  speaks_against e -> state_of m = St_recalibrating -> does m e A_discard_fit \/ does m e A_restart_collection.
Proof. unfold speaks_against. revert m e. every_cell. Qed.

(* S16: an alarm ends recalibration in flight. *)
Theorem S16_alarm_aborts_recalibration c f :
  goes M_recalibrating E_alarm c f = M_suspect /\ does M_recalibrating E_alarm A_discard_fit.
Proof. unfold does, goes. simpl. tauto. Qed.

(* S9: sensors come back into service by a passed probation only, or by the operator's reset out of failed. A channel that
   delivers again is merely marked. *)
Theorem S9_readmission m e :
  (does m e A_reinstate -> e = E_probation_passed) /\
  (does m e A_return_named_sensors -> e = E_reset /\ m = M_failed).
Proof. revert m e. every_cell; repeat split; intuition discriminate. Qed.

(* What an event says is done wherever the event is taken up: the lost channel is marked, the culprit excluded, the accused
   set aside, the returning channel marked, the accepted fit adopted. (S2 rests on it: what is out stays out.) *)
Theorem S2_events_do_what_they_say m e :
  kind_of m e = K_taken ->
  (e = E_channel_lost -> does m e A_mark_absent) /\ (e = E_exclusion -> does m e A_exclude) /\
  (e = E_provisional_exclusion -> does m e A_exclude_provisionally) /\ (e = E_channel_back -> does m e A_mark_as_back) /\
  (e = E_fit_accepted -> does m e A_adopt_fit) /\ (e = E_recalibrate -> does m e A_start_fit) /\
  (e = E_reset -> does m e A_return_named_sensors /\ does m e A_not_yet_validated).
Proof. revert m e. every_cell; repeat split; intuition discriminate. Qed.

(* They are taken up: no mode overlooks a lost or a returning channel. *)
Theorem S4_channel_events_count m e :
  e = E_channel_lost \/ e = E_channel_back -> kind_of m e = K_taken.
Proof. revert m e. every_cell. Qed.

(* Nothing moves the machine but events that may: none happened, a channel that is merely back, a reset out of place. *)
Theorem bystanders_move_nothing m e c f :
  e = E_none \/ e = E_channel_back \/ (e = E_reset /\ m <> M_failed) -> goes m e c f = m.
Proof. revert m e. every_cell. Qed.

(* Recalibration in flight begins on request only, with a fit started; the first calibration is entered by a reset only. *)
Theorem recalibration_begins_on_request m e c f :
  goes m e c f <> m ->
  (goes m e c f = M_recalibrating -> e = E_recalibrate /\ does m e A_start_fit) /\
  (goes m e c f = M_recalibrating_initial -> e = E_reset /\ m = M_failed /\ c = false).
Proof. revert m e. every_cell; every_fact. Qed.
Theorem a_request_taken_recalibrates m c f :
  kind_of m E_recalibrate = K_taken -> goes m E_recalibrate c f = M_recalibrating.
Proof. destruct m; unfold kind_of, goes; simpl; intros; settle. Qed.

(* S17 (its part in the table): alarm, no_consistent_hypothesis, norm_mismatch and a provisional exclusion never leave the monitor in a mode
   whose output is published as valid or degraded, nor in recalibration in flight, which publishes as before. *)
Definition publishes (m : mode) : Prop := m = M_nominal \/ m = M_isolated \/ m = M_degraded.
Theorem S17_doubt_is_not_published m e c f :
  e = E_alarm \/ e = E_no_consistent_hypothesis \/ e = E_norm_mismatch \/ (e = E_provisional_exclusion /\ kind_of m e = K_taken) ->
  ~ publishes (goes m e c f) /\ goes m e c f <> M_recalibrating.
Proof. unfold publishes. revert m e. every_cell; every_fact. Qed.

(* Out of suspect the ways into service are passed blocks, enough in a row, or an exclusion. *)
Theorem suspect_is_left_by_evidence e c f :
  publishes (goes M_suspect e c f) -> (e = E_passed_block /\ enough_passed f = true) \/ (e = E_exclusion /\ not_yet_validated f = false).
Proof. unfold publishes. revert e. intros e. destruct e; unfold goes; simpl; intros; settle; every_fact. Qed.

(* S12 (its part in the table): isolation timeout in suspect: bounded, or with an explanation that the rest corroborates
   ([within]), or failed. *)
Theorem S12_isolation_timeout c f :
  goes M_suspect E_isolation_timeout c f = (if within f then M_suspect else M_failed).
Proof. destruct f as [s u r b w]. destruct w; reflexivity. Qed.

(* L2 (its part in the table): enough passed blocks in a row lead out of suspect. *)
Theorem L2_earned_trust_ends_suspect c f :
  enough_passed f = true -> goes M_suspect E_passed_block c f <> M_suspect.
Proof. destruct f as [s u r b w]. simpl. intros ->. destruct s; discriminate. Qed.

(* From failed the operator's reset leads to suspect or to a first calibration, never straight
   into service, as long as the sensors named have rank. *)
Theorem reset_leads_out c f :
  goes M_failed E_reset c f =
  match size_left f with S_rank_lost => M_failed | _ => if c then M_suspect else M_recalibrating_initial end.
Proof. destruct f as [s u r b w]. destruct s, c; reflexivity. Qed.

(* --- Runs of the machine: any events, any facts, as long as one likes. ------------------------------------------ *)
Scheme Equality for action.
Definition adopts (m : mode) (e : event) : bool := existsb (action_beq A_adopt_fit) (snd (cell m e)).
Definition step (s : mode * bool) (ef : event * facts) : mode * bool :=
  let '(m, calibrated) := s in let '(e, f) := ef in (goes m e calibrated f, calibrated || adopts m e).
Definition run (s : mode * bool) (trace : list (event * facts)) : mode * bool := fold_left step trace s.

Lemma invariant (P : mode * bool -> Prop) :
  (forall m c e f, P (m, c) -> P (step (m, c) (e, f))) -> forall trace s, P s -> P (run s trace).
Proof.
  intros Step trace. induction trace as [|[e f] trace IH]; intros [m c] H; [exact H|].
  simpl. apply IH. exact (Step m c e f H).
Qed.

(* S7 over a whole run: however long the tool moves and whatever is said of it, the monitor is where it was or in suspect. *)
Definition motion_step (m : mode) (ecf : event * (bool * facts)) : mode :=
  let '(e, (c, f)) := ecf in if heeds m e f then goes m e c f else m.
Theorem S7_motion_leads_to_suspect_at_most m trace :
  fold_left motion_step trace m = m \/ fold_left motion_step trace m = M_suspect.
Proof.
  revert m. induction trace as [|[e [c f]] trace IH]; intros m; [now left|]. simpl.
  destruct (heeds m e f) eqn:H; [|apply IH].
  destruct (S7_motion_decides_nothing_for_good m e c f H) as [_ [_ [-> _]]].
  right. destruct (IH M_suspect); assumption.
Qed.

(* S5: without a reset, failed is for ever. *)
Theorem S5_failed_is_latched c trace :
  (forall ef, In ef trace -> fst ef <> E_reset) -> fst (run (M_failed, c) trace) = M_failed.
Proof.
  revert c. induction trace as [|[e f] trace IH]; intros c H; [reflexivity|].
  assert (step (M_failed, c) (e, f) = (M_failed, c)) as E.
  { specialize (H (e, f) (or_introl eq_refl)). destruct e; simpl in H; try contradiction; unfold step, goes, adopts; simpl;
      rewrite ?orb_false_r; reflexivity. }
  change (fst (run (step (M_failed, c) (e, f)) trace) = M_failed). rewrite E. apply IH.
  intros ef Hin. apply H. now right.
Qed.

(* S19: from a start without calibration, and until one is accepted, the monitor is in its first calibration or failed:
   nothing is published as valid or degraded. *)
Theorem S19_nothing_valid_before_calibration trace :
  let '(m, calibrated) := run (M_recalibrating_initial, false) trace in
  calibrated = false -> m = M_recalibrating_initial \/ m = M_failed.
Proof.
  pose (P := fun s : mode * bool => snd s = false -> fst s = M_recalibrating_initial \/ fst s = M_failed).
  assert (P (run (M_recalibrating_initial, false) trace)) as H.
  { apply invariant; [|intros _; now left]. unfold P. intros m c e f Hyp. simpl.
    intros Now. apply orb_false_iff in Now as [-> Not]. destruct (Hyp eq_refl) as [E|E]; simpl in E; subst m;
      destruct e; unfold goes; simpl in *; settle; every_fact. }
  unfold P in H. destruct (run (M_recalibrating_initial, false) trace). exact H.
Qed.

(* No dead end: from every mode some events and facts lead to nominal, so no mode locks a healthy tool out. *)
Theorem no_dead_end m : exists trace, fst (run (m, true) trace) = M_nominal.
Proof.
  pose (good := Facts S_all_configured false true false true).
  destruct m; [exists []| exists [(E_probation_passed, good)] | exists [(E_passed_block, good)]
    | exists [(E_probation_passed, good)] | exists [(E_fit_accepted, good); (E_passed_block, good)]
    | exists [(E_fit_accepted, good); (E_passed_block, good)] | exists [(E_reset, good); (E_passed_block, good)]]; reflexivity.
Qed.
