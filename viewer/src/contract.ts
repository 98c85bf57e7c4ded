// SPDX-License-Identifier: Apache-2.0
// What the server says. The C++ side of every type here is app/view_model.hpp; names are the same.

export type LimitClass = 'AL' | 'IL' | 'IAL';

/** GET /api/result */
export interface Result {
  kind: 'survey' | 'georef';
  title: string; // line and track, or the folder's name
  subtitle: string; // length, speed, time of day
  version: string; // of the program that wrote the result
  crs: string; // definition of the project CRS; easting and northing below are its metres
  running: boolean; // the job is still writing
  progress?: { stage: string; fraction: number };
  report: boolean; // report.html lies in the result
  verdict: Verdict;
  survey?: Survey;
  georef?: Georef;
  warnings: string[];
  findings: Finding[];
  rejections: Rejection[];
}

export interface Verdict {
  accepted: boolean | null; // null: nothing was judged
  text: string; // "NOT ACCEPTED 1 IAL 7 IL 2 AL"
}

export interface Finding {
  sensor: string;
  kind: string;
  from: number; // s from the start of the run
  to: number;
  count: number;
  action: string;
  detail: string;
}

export interface Rejection {
  sensor: string;
  time: number; // s from the start of the run
  reason: string;
  normalized: number | null;
}

export interface Survey {
  x: { from: number; to: number; count: number; step: number }; // continuous track distance, m
  chainage: ChainagePiece[];
  strips: StripInfo[];
  plan: Polyline[]; // track axis in the project CRS
  exceedances: Exceedance[];
  controlPoints: ControlPoint[];
  packUp: PackUpItem[];
  compare?: string; // title of the run that is compared
}

/** Posted kilometre on a piece of continuous distance: km = posted + sign * (x - from). */
export interface ChainagePiece {
  from: number;
  to: number;
  posted: number; // m
  sign: 1 | -1;
}

export interface StripInfo {
  id: string; // as in /api/series/{id} and as the column of geometry.csv
  title: string; // "Level left"
  note: string; // "D1, 3-25 m"
  unit: string; // "mm"
  positive: string; // sign convention: "positive: to the left"
  digits: number;
  tab: 'strips' | 'versines' | 'difference' | 'adjustment';
  sigma: boolean;
  limits: { class: LimitClass; low: number | null; high: number | null }[];
}

export interface Polyline {
  id: string;
  x: number[]; // continuous distance of each vertex, m
  easting: number[];
  northing: number[];
}

export interface Exceedance {
  strip: string;
  title: string;
  class: LimitClass;
  start: number; // continuous distance, m
  end: number;
  peakAt: number;
  peak: number;
  sigma: number | null;
  probability: number | null; // that the limit is exceeded
  unit: string;
}

export interface ControlPoint {
  name: string;
  x: number;
  residual: [number, number, number]; // mm: along, across, up
  sigma: [number, number, number];
  used: boolean;
}

export interface PackUpItem {
  name: string; // "gaps", "missing control points", "closure", "forward/backward"
  good: boolean;
  text: string;
}

export interface Georef {
  journeys: Journey[];
  bounds: [number, number, number, number]; // easting, northing of the network
}

export interface Journey {
  id: string;
  title: string;
  from: number; // s
  to: number;
  length: number; // m
  hypotheses: Hypothesis[];
  stretches: Stretch[]; // ambiguous ones, least certain first
}

export interface Hypothesis {
  id: number; // 1 is the best
  probability: number;
  logLikelihood: number;
  tracks: string[];
  easting: number[];
  northing: number[];
}

export interface Stretch {
  from: number; // s
  to: number;
  alternatives: { hypothesis: number; probability: number }[];
  gap: number; // difference of log-likelihoods to the runner-up
  evidence: string;
}

/** GET /api/series/{id}?from&to&buckets: float64 x, float32 min, max, lower, upper a bucket; NaN where nothing was measured. */
export interface Series {
  x: Float64Array;
  min: Float32Array;
  max: Float32Array;
  lower: Float32Array | null; // value - 1.96 sigma, smallest in the bucket
  upper: Float32Array | null;
}
