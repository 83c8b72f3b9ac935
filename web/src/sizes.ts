// What each sensor of a design must be off by, before it is seen and before it is named.
import { figure, mg0, table } from "./dom";

/** Thresholds of the document of `plumb geometry --json`, by sensor. */
// eslint-disable-next-line @typescript-eslint/no-explicit-any
export function sensorSizes(said: any): HTMLElement {
  const columns: [string, string][] = [
    ["minimum_detectable_bias", "minimum detectable bias"],
    ["guaranteed_detection_any", "guaranteed detection, any attitude"],
    ["guaranteed_isolation", "guaranteed isolation, 4 attitudes"],
    ["provisional_exclusion", "provisional exclusion by parity"],
  ];
  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  const rows = said.sensors.map((sensor: any) => [
    sensor.id,
    ...columns.map(([key]) => mg0(sensor.thresholds_mps2[key] ?? null)),
    figure(sensor.nearest_mirror_axis_deg || null, "deg"),
  ]);
  return table("Thresholds of every sensor", ["sensor", ...columns.map(([, words]) => words), "nearest mirror axis"], rows);
}
