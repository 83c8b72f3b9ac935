# The state machine as `plumb model --format json` tells it -> a Coq file. Run by proofs/check_coq.sh; the result is
# never kept. Names become constructors: "by size (not yet validated: suspect)" -> T_by_size_not_yet_validated_suspect.
def name(prefix): prefix + (gsub("[^A-Za-z0-9]+"; "_") | sub("_$"; ""));
def listed: join(" | ");
def bool: if . == null then "_" elif . then "true" else "false" end;

([.cells[].kind] | unique) as $kinds
| ([.cells[].actions[]] | unique) as $actions
| ([.targets[].target] | unique) as $targets
| (["rank lost", "critical", "all configured", "reduced"]) as $sizes
| "(* Generated from the table in the code; do not edit. *)",
  "From Coq Require Import List Bool. Import ListNotations.",
  "Inductive mode := \([.modes[].mode | name("M_")] | listed).",
  "Inductive state := \([.modes[].state | name("St_")] | unique | listed).",
  "Inductive event := \([.events_in_rank_order[] | name("E_")] | listed).",
  "Inductive kind := \([$kinds[] | name("K_")] | listed).",
  "Inductive action := \([$actions[] | name("A_")] | listed).",
  "Inductive target := \([$targets[] | name("T_")] | listed).",
  "Inductive size := \([$sizes[] | name("S_")] | listed).",
  "Definition all_modes := [\([.modes[].mode | name("M_")] | join("; "))].",
  "Definition all_events := [\([.events_in_rank_order[] | name("E_")] | join("; "))].",
  "Definition all_sizes := [\([$sizes[] | name("S_")] | join("; "))].",
  "Definition all_actions := [\([$actions[] | name("A_")] | join("; "))].",
  "Definition state_of (m : mode) : state := match m with",
  (.modes[] | "  | \(.mode | name("M_")) => \(.state | name("St_"))"),
  "  end.",
  "(* Coq refuses a missing and a doubled cell alike. *)",
  "Definition cell (m : mode) (e : event) : kind * target * list action := match m, e with",
  (.cells[] | "  | \(.mode | name("M_")), \(.event | name("E_")) => (\(.kind | name("K_")), \(.target | name("T_")), [\([.actions[] | name("A_")] | join("; "))])"),
  "  end.",
  "(* Whether the cell is taken as well where a monitor in motion raised the event. *)",
  "Definition from_motion (m : mode) (e : event) : bool := match m, e with",
  (.cells[] | "  | \(.mode | name("M_")), \(.event | name("E_")) => \(.from_motion)"),
  "  end.",
  "(* Where a target leads, in the order size, not_yet_validated, enough_passed, from suspect, bounded or isolable, calibrated; None: stay. *)",
  "Definition resolution (t : target) (s : size) (not_yet_validated enough_passed from_suspect within calibrated : bool) : option mode :=",
  "  match t, s, not_yet_validated, enough_passed, from_suspect, within, calibrated with",
  (.targets[] | "  | \(.target | name("T_")), \(if .when.size then (.when.size | name("S_")) else "_" end), \(.when["not yet validated"] | bool), \(.when["enough blocks passed"] | bool), \(.when["from suspect"] | bool), \(.when["bounded or isolable"] | bool), \(.when.calibrated | bool) => \(if .to == "stay" then "None" else "Some " + (.to | name("M_")) end)"),
  "  end.",
  "Definition leads_to (m : mode) (e : event) : list mode := match m, e with",
  (.cells[] | "  | \(.mode | name("M_")), \(.event | name("E_")) => [\([.leads_to[] | name("M_")] | join("; "))]"),
  "  end."
