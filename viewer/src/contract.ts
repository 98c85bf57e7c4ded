// SPDX-License-Identifier: Apache-2.0
// What the server says. The C++ side of every type here is app/view_model.hpp; names are the same.

export type LimitClass = 'AL' | 'IL' | 'IAL';

/** GET /api/result */
export interface Result {
  kind: 'survey' | 'georef' | 'waiting'; // waiting: a job is running that has no result yet
  title: string; // line and track, or the folder's name
  subtitle: string; // length, speed, time of day
  folder: string;
  version: string; // of the program that wrote the result
  started: string; // UTC
  crs: string; // definition of the project CRS; easting and northing below are its metres
  report: boolean; // report.html lies in the result
  verdict: Verdict;
  survey?: Survey;
  georef?: Georef;
  failure?: string; // why there is nothing to see
  background?: string; // as in Progress
  partial?: string; // stage that a running job has come to; nothing here is final
  warnings: string[];
  findings: Finding[];
  rejections: Rejection[]; // the first 500
  rejected: number; // all of them
}

/** GET /api/progress: whether a job is writing this result, and which generation of the result the server has open. */
export interface Progress {
  running: boolean;
  background: string; // name of the picture under the plan; empty: none
  generation: number;
  opened: boolean;
  failure: string;
  stage?: string;
  fraction?: number;
  seconds?: number;
  stages?: { stage: string; seconds: number }[];
  notes?: string[];
}

export interface Verdict {
  accepted: boolean | null; // null: nothing was judged
  text: string; // "NOT ACCEPTED · 1 IAL · 7 IL"
  profile?: string; // of the limits
  source?: string;
}

/** As in run.json. */
export interface Finding {
  sensor: string;
  kind: string;
  from: string;
  count: number;
  action: string;
  detail: string;
}

export interface Rejection {
  sensor: string;
  time_s: string;
  reason: string;
  normalized: number | null;
}

export interface Survey {
  axis: 'mileage' | 'time'; // what x is: continuous track distance in m, or seconds from `origin`
  origin?: string;
  x: { from: number; to: number; count: number; step: number };
  chainage: ChainagePiece[];
  tabs: { id: string; title: string }[];
  strips: StripInfo[];
  plan: Polyline[]; // track axis in the project CRS
  exceedances: Exceedance[];
  controlPoints: ControlPoint[];
  packUp: PackUpItem[];
  conventions?: Record<string, string>;
  compare?: string; // title of the run that is subtracted
  recorded?: Partial<Record<'fixes' | 'landmarks', { easting: (number | null)[]; northing: (number | null)[] }>>; // of a running job
}

/** Posted kilometre on a piece of continuous distance: km = posted + sign * (x - from). */
export interface ChainagePiece {
  from: number;
  to: number;
  posted: number; // m
  sign: 1 | -1;
}

export interface StripInfo {
  id: string; // as in /api/series/{id}, and the column of geometry.csv
  title: string; // "Level left"
  note: string; // "D1, 3-25 m"
  unit: string; // "mm"
  positive: string; // sign convention: "+ up"
  digits: number;
  tab: string;
  count: number; // of samples
  sigma: boolean;
  limits: { level: string; class: LimitClass; low: number | null; high: number | null }[];
  companion?: { id: string; title: string; unit: string; digits: number }; // drawn dashed, on a scale of its own
}

export interface Polyline {
  x: number[]; // of each vertex
  easting: number[];
  northing: number[];
  latitude?: number[]; // deg, WGS84
  longitude?: number[];
}

export interface Exceedance {
  strip: string;
  title: string;
  note: string;
  level: string; // as the profile of limits names it
  class: LimitClass; // how it is drawn
  start: number; // continuous distance, m
  end: number;
  peakAt: number;
  peak: number;
  limit: number;
  sigma: number | null;
  probability: number | null; // that the limit is exceeded
  digits: number;
  unit: string;
}

/** A control point as the forward pass met it: prediction against measurement, before it was used. */
export interface ControlPoint {
  name: string;
  x: number;
  time: number; // s
  innovation: [number | null, number | null, number | null]; // mm: north, east, down
  sigma: [number | null, number | null, number | null];
  nis: number | null;
  used: boolean;
}

export interface PackUpItem {
  name: string; // "gaps in the trajectory", "control points"
  good: boolean;
  text: string;
}

export interface Georef {
  network: { tracks: number; names: string[]; bounds: [number, number, number, number]; warnings: string[] };
  journeys: Journey[];
  failures: { recording: string; error: string }[];
  strips: StripInfo[]; // of every journey; the series are `${journey.id}:t:${strip.id}` over time, `:d:` over distance
  constraintsFile: string;
  compare?: string; // title of the run that is compared
}

/** Where path 1 is on other tracks than path 1 of the other run. */
export interface Difference {
  fromM: number; // m on path 1
  toM: number;
  here: string[]; // tracks
  there: string[];
}

export interface Journey {
  id: string; // "1.2": recording and journey, from 1
  recording: string;
  number: number;
  from: number; // s of the recording's clock
  to: number;
  length: number; // m
  count: number; // of positions
  fixes: number;
  rejected: number;
  entropy: number; // nat
  hypotheses: Hypothesis[]; // the most probable first
  stretches: Stretch[]; // ambiguous ones, least certain first
  other?: Hypothesis | null; // path 1 of this journey in the run that is compared; null: it has none
  differs?: Difference[];
}

export interface Hypothesis {
  path: number; // 1 is the most probable
  probability: number;
  logLikelihood: number;
  evidence: Evidence;
  from: number; // m on the path
  to: number;
  tracks: { id: string; line: string; from: number; to: number }[]; // m on the path
  x: number[]; // m on the path, of each vertex
  easting: number[];
  northing: number[];
}

/** Parts of a log-likelihood, or of a difference of two. */
export type Evidence = Partial<Record<'position' | 'speed' | 'turn_rate' | 'route', number>>;

/** Where a plausible path leaves the most probable one. */
export interface Stretch {
  from: number; // s of the recording's clock
  to: number;
  fromM: number; // m on path 1
  toM: number;
  taken: string[]; // tracks of path 1
  alternative: string[];
  paths: number[]; // that take the alternative
  probability: number; // of the alternative
  evidence: Evidence; // for path 1
}

/** What a reviewer decided: docs/formats-georef.md. */
export interface Constraint {
  /** None: every recording. */
  recording?: string;
  from_s: number;
  to_s: number;
  tracks: string[];
  excluded?: boolean;
  comment?: string;
}

/** GET /api/map/{part}: groups of points. */
export interface Points {
  origin: [number, number];
  start: Uint32Array; // of each group, and the end
  places: Float32Array; // easting, northing from the origin
}

/** GET /api/series/{id}?from&to&buckets: samples where few enough lie there (min and max are then the same array), else
 * buckets; NaN where nothing was measured. */
export interface Series {
  x: Float64Array;
  min: Float32Array;
  max: Float32Array;
  lower: Float32Array | null; // value - 1.96 sigma, smallest in the bucket
  upper: Float32Array | null;
  sigma?: Float32Array; // of samples
}

/** GET /api/values?x: value and sigma of each series that has been looked at. */
export type Values = Record<string, [number | null, number | null]>;
