// SPDX-License-Identifier: Apache-2.0
import type { Series } from './contract';

/** From values to canvas pixels. */
export interface Frame {
  left: number;
  top: number;
  width: number;
  height: number;
  from: number;
  to: number;
  low: number;
  high: number;
}

const px = (f: Frame, x: number) => f.left + ((x - f.from) / (f.to - f.from)) * f.width;
const py = (f: Frame, y: number) => f.top + ((f.high - y) / (f.high - f.low)) * f.height;

/** The 95 % band: one outline a stretch without gap, or columns where several samples fall on a pixel. */
export function drawBand(ctx: CanvasRenderingContext2D, f: Frame, series: Series): void {
  const { x, lower, upper } = series;
  if (!lower || !upper) return;
  if (isDense(f, series)) return drawColumns(ctx, f, x, lower, upper, false);
  ctx.beginPath();
  for (let a = 0; a < x.length; ++a) {
    if (lower[a] !== lower[a]) continue;
    let b = a;
    ctx.moveTo(px(f, x[a]), py(f, upper[a]));
    while (b + 1 < x.length && lower[b + 1] === lower[b + 1]) ctx.lineTo(px(f, x[++b]), py(f, upper[b]));
    for (let i = b; i >= a; --i) ctx.lineTo(px(f, x[i]), py(f, lower[i]));
    ctx.closePath();
    a = b;
  }
  ctx.fill();
}

/** Columns of whole pixels cost a fraction of an outline or a stroked zigzag. */
const isDense = (f: Frame, series: Series) => series.min !== series.max || series.x.length > f.width;

/** Samples as a line; where several fall on a pixel, its column from their smallest to their largest value. */
export function drawValues(ctx: CanvasRenderingContext2D, f: Frame, series: Series, thickness: number): void {
  if (isDense(f, series)) drawColumns(ctx, f, series.x, series.min, series.max, true);
  else drawLine(ctx, f, series.x, series.min, thickness);
}

export function drawLine(ctx: CanvasRenderingContext2D, f: Frame, x: Float64Array, y: Float32Array, thickness: number): void {
  ctx.beginPath();
  let open = false;
  for (let i = 0; i < x.length; ++i) {
    if (y[i] !== y[i]) {
      open = false;
      continue;
    }
    const [u, v] = [px(f, x[i]), py(f, y[i])];
    if (open) ctx.lineTo(u, v);
    else ctx.moveTo(u, v);
    // A sample between two gaps has no line: a dot.
    if (!open && (i + 1 === x.length || y[i + 1] !== y[i + 1])) ctx.lineTo(u + 1, v);
    open = true;
  }
  ctx.lineWidth = thickness;
  ctx.stroke();
}

function drawColumns(ctx: CanvasRenderingContext2D, f: Frame, x: Float64Array, min: Float32Array, max: Float32Array, joined: boolean): void {
  let column = -1;
  let [top, bottom] = [Infinity, -Infinity];
  let last: [number, number] | null = null; // the column before, unless a gap lies between
  const flush = (until: number) => {
    if (column < 0 || !(bottom >= top)) return;
    // The line from column to column, where they do not overlap.
    const a = last && joined ? Math.min(top, last[1]) : top;
    const b = last && joined ? Math.max(bottom, last[0]) : bottom;
    ctx.fillRect(column, Math.round(a), Math.max(until - column, 1), Math.max(Math.round(b) - Math.round(a), 1));
    last = [top, bottom];
  };
  for (let i = 0; i < x.length; ++i) {
    const at = Math.floor(px(f, x[i]));
    if (at !== column || min[i] !== min[i]) {
      flush(at);
      column = at;
      [top, bottom] = [Infinity, -Infinity];
    }
    if (min[i] !== min[i]) {
      last = null;
      column = -1;
      continue;
    }
    top = Math.min(top, py(f, max[i]));
    bottom = Math.max(bottom, py(f, min[i]));
  }
  flush(column + 1);
}
