// What the second view begins with.
import type { Scene } from "./core";
import { kG0 } from "./dom";
import { onSensors } from "./faults";
import type { Geometry } from "./geometry";

export interface Preset {
  id: string;
  words: string;
  what: string;
  /** A name that `shapeOf` knows. */
  geometry: string;
  /** Faults may name a chip: "chip2:bias=50mg0@station6". */
  scene: Partial<Scene>;
}

export const kPresets: Preset[] = [
  {
    id: "drilling",
    words: "One sensor goes dead while drilling",
    what: "a2 stands at 0 V from the sixth station on. The monitor marks its output, and excludes a2 when four attitudes agree.",
    geometry: "paper-tetrahedron",
    scene: { faults: ["a2:stuck=0V@station6"], stations: 14, inclination_deg: 5, build_deg: 4.2, seed: 2 },
  },
  {
    id: "drill-a",
    words: "Drill A: two of four sensors fail, one after the other",
    what: "Three sensors detect the second fault and cannot isolate it: the monitor fails, and the host resets it with a2, which is healthy again.",
    geometry: "paper-tetrahedron",
    scene: {
      faults: ["a2:stuck=0V@station6+station15", "a3:stuck=3V@station12"],
      requests: ["63.5s reset a2 key 1", "64s reset a2 key 0x706c756d62"],
      stations: 30,
    },
  },
  {
    id: "drill-b",
    words: "Drill B: an offset, a recalibration and a dead sensor, of six",
    what: "a2 reads 50 mg0 too much from station 6 to 25. The host asks for a recalibration, and a5 gets stuck at station 30.",
    geometry: "platonic:6",
    scene: {
      faults: ["a2:bias=50mg0@station6+station20", "a5:stuck=0V@station30"],
      requests: ["36.5s recalibrate"],
      stations: 44,
    },
  },
  {
    id: "table2",
    words: "Table 2 of the paper: its 23 experiments",
    what: "No fault, one or two sensors at 0 V, -3 V, +3 V or at random. Choose an experiment, or play them all: the paper's rule, plumb and PX4 see the same samples.",
    geometry: "paper-tetrahedron",
    scene: { faults: [], stations: 44, dwell_s: 0.7, move_s: 0.5 },
  },
  {
    id: "chip",
    words: "A chip fails: all three axes at once",
    what: "Two chips of three axes. From the sixth station on every axis of chip 2 reads 20 mg0 too much. A chip is one fault: plumb excludes it as a whole.",
    geometry: "chips:2",
    scene: { faults: ["chip2:bias=20mg0@station6"], stations: 20 },
  },
  {
    id: "flight",
    words: "A drone's chip fails in flight",
    what: "Three parallel chips on a drone, as an autopilot has them. Two seconds into the flight every axis of chip 1, the one that PX4 uses, reads 0.3 g0 too much.",
    geometry: "chips:3",
    scene: { motion: "drone", faults: ["chip1:bias=300mg0@2s"], duration_s: 6 },
  },
  {
    id: "turning",
    words: "A sensor fails while the drill string turns",
    what: "Six sensors under rotation, vibration and shocks. a3 reads 0.5 g0 too much from 2.5 s on, and no window at rest is needed to see it.",
    geometry: "platonic:6",
    scene: { motion: "drilling", faults: ["a3:bias=500mg0@2.5s"], duration_s: 6 },
  },
  {
    id: "roll",
    words: "A roll test with a scale factor that is wrong",
    what: "The tool lies and is rolled, sixteen toolfaces in a turn. The scale factor of a2 is 2 % too large from the fifth on.",
    geometry: "paper-tetrahedron",
    scene: { motion: "roll", inclination_deg: 90, stations: 16, faults: ["a2:scale=1.02@station5"] },
  },
  {
    id: "mirror",
    words: "The mirror fault: every triple but one is plausible",
    what: "a1 shows gravity mirrored in the plane of a2 and a3: the length stays right, and only more attitudes can tell.",
    geometry: "paper-tetrahedron",
    scene: { faults: ["a1:mirror=a2*a3@station5"], stations: 20 },
  },
  {
    id: "gravity",
    words: "The wrong gravity",
    what: "Gravity is 3 mg0 longer than was stated. Nobody is excluded: the readings agree with one another.",
    geometry: "platonic:6",
    scene: { faults: ["log:gravity=3mg0@station4"], stations: 16 },
  },
  {
    id: "drift",
    words: "A slow drift",
    what: "The error of a3 grows by 1 mg0 a second, below every limit at first.",
    geometry: "platonic:6",
    scene: { faults: ["a3:drift=1mg0/s@station3"], stations: 20 },
  },
  {
    id: "healthy",
    words: "Nothing is wrong",
    what: "All sensors are healthy: no alarm may be raised.",
    geometry: "paper-tetrahedron",
    scene: { faults: [], stations: 14 },
  },
];

export function sceneOf(geometry: Pick<Geometry, "axes" | "chips" | "noise_mps2">, part: Partial<Scene>): Scene {
  return {
    axes: geometry.axes,
    chips: geometry.chips,
    noise_mps2: geometry.noise_mps2,
    motion: "stations",
    duration_s: 6,
    truth_seed: 1,
    stand_seed: 1,
    seed: 3,
    stations: 14,
    inclination_deg: 20,
    build_deg: 1.5,
    toolface_step_deg: 137.5,
    dwell_s: 2,
    move_s: 1,
    vibration_mps2: 0.1 * kG0,
    requests: [],
    ...part,
    faults: onSensors(part.faults ?? [], geometry.chips),
  };
}
