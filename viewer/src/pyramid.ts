// SPDX-License-Identifier: Apache-2.0
import { getSeries } from './api';
import type { Series } from './contract';

/** Beyond this many samples the browser asks the server for what it draws instead of holding everything. */
export const clientLimit = 500_000;
const factor = 2;
const maxBuckets = 1400; // some two a pixel of the widest strip on a usual screen

/** Smallest of mins and lowers, largest of maxs and uppers of `factor` neighbours; NaN only where all are. */
function reduce(series: Series): Series {
  const n = Math.ceil(series.x.length / factor);
  const out: Series = {
    x: new Float64Array(n),
    min: new Float32Array(n),
    max: new Float32Array(n),
    lower: series.lower && new Float32Array(n),
    upper: series.upper && new Float32Array(n),
  };
  const fold = (from: Float32Array, to: Float32Array, smaller: boolean) => {
    for (let i = 0; i < n; ++i) {
      let best = NaN;
      const end = Math.min(from.length, (i + 1) * factor);
      for (let k = i * factor; k < end; ++k) {
        const v = from[k];
        if (v === v && (best !== best || (smaller ? v < best : v > best))) best = v;
      }
      to[i] = best;
    }
  };
  for (let i = 0; i < n; ++i) out.x[i] = series.x[i * factor];
  fold(series.min, out.min, true);
  fold(series.max, out.max, false);
  if (series.lower && out.lower) fold(series.lower, out.lower, true);
  if (series.upper && out.upper) fold(series.upper, out.upper, false);
  return out;
}

/** Index of the first element that is not less. */
export function lowerBound(x: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

function slice(series: Series, from: number, to: number): Series {
  const a = Math.max(0, lowerBound(series.x, from) - 1);
  const b = Math.min(series.x.length, lowerBound(series.x, to) + 1);
  return {
    x: series.x.subarray(a, b),
    min: series.min.subarray(a, b),
    max: series.max.subarray(a, b),
    lower: series.lower && series.lower.subarray(a, b),
    upper: series.upper && series.upper.subarray(a, b),
  };
}

/** One strip's values at every zoom: from the server at first, from memory as soon as all samples have come. */
export class SeriesStore {
  private levels: Series[] = [];
  private loading: Promise<void> | null = null;

  constructor(
    readonly id: string,
    readonly count: number,
  ) {}

  get loaded(): boolean {
    return this.levels.length > 0;
  }

  /** Fetches every sample, unless there are too many to hold. */
  load(): Promise<void> {
    if (this.count > clientLimit) return Promise.resolve();
    this.loading ??= getSeries(this.id).then((samples) => {
      const levels = [samples];
      while (levels[levels.length - 1].x.length > maxBuckets) levels.push(reduce(levels[levels.length - 1]));
      this.levels = levels;
    });
    return this.loading;
  }

  /** What to draw between two places: at most 2,400 buckets, or the samples themselves. */
  fetch(from: number, to: number): Promise<Series> {
    return getSeries(this.id, from, to, maxBuckets);
  }

  now(from: number, to: number): Series {
    for (const level of this.levels) {
      const part = slice(level, from, to);
      if (part.x.length <= maxBuckets) return part;
    }
    return slice(this.levels[this.levels.length - 1], from, to);
  }

  /** The sample nearest to a place. Only of a loaded store. */
  at(x: number): { value: number; sigma: number } | null {
    const s = this.levels[0];
    if (!s || s.x.length === 0) return null;
    let i = Math.min(lowerBound(s.x, x), s.x.length - 1);
    if (i > 0 && x - s.x[i - 1] < s.x[i] - x) i -= 1;
    return { value: s.min[i], sigma: s.sigma ? s.sigma[i] : NaN };
  }

  /** Samples from one place to another, both included. */
  async samples(from: number, to: number): Promise<Series> {
    const all = this.loaded ? this.levels[0] : await getSeries(this.id, from, to, 0);
    const [a, b] = [lowerBound(all.x, from), lowerBound(all.x, to + 1e-9)];
    return { x: all.x.subarray(a, b), min: all.min.subarray(a, b), max: all.max.subarray(a, b), lower: null, upper: null, sigma: all.sigma?.subarray(a, b) };
  }
}
