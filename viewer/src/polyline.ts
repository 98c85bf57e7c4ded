// SPDX-License-Identifier: Apache-2.0
import { lowerBound } from './pyramid';

export type Place = [number, number];

/** A line whose vertices know their distance x along it. */
export interface Measured {
  x: number[];
  easting: number[];
  northing: number[];
}

/** The point at a distance and the direction there; null outside the line. */
export function apart(line: Measured, x: number): { place: Place; direction: Place } | null {
  const n = line.x.length;
  if (n < 2 || !(x >= line.x[0] - 1e-6) || !(x <= line.x[n - 1] + 1e-6)) return null;
  const i = Math.min(Math.max(lowerBound(line.x, x), 1), n - 1);
  const [de, dn] = [line.easting[i] - line.easting[i - 1], line.northing[i] - line.northing[i - 1]];
  const f = (x - line.x[i - 1]) / (line.x[i] - line.x[i - 1] || 1);
  const length = Math.hypot(de, dn) || 1;
  return { place: [line.easting[i - 1] + f * de, line.northing[i - 1] + f * dn], direction: [de / length, dn / length] };
}

/** The piece between two distances, as far as the line goes. */
export function part(line: Measured, from: number, to: number): Place[] {
  const n = line.x.length;
  if (n < 2) return [];
  const [a, b] = [Math.max(from, line.x[0]), Math.min(to, line.x[n - 1])];
  if (!(b > a)) return [];
  const out: Place[] = [apart(line, a)!.place];
  for (let i = lowerBound(line.x, a); i < n && line.x[i] < b; ++i) if (line.x[i] > a) out.push([line.easting[i], line.northing[i]]);
  out.push(apart(line, b)!.place);
  return out;
}

/** The line moved to its right. Corners are mitred, sharp ones cut. */
export function offset(line: Place[], right: number): Place[] {
  if (right === 0) return line;
  const normal = (a: Place, b: Place): Place => {
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    return [(b[1] - a[1]) / length, -(b[0] - a[0]) / length];
  };
  return line.map((p, i) => {
    const before = i > 0 ? normal(line[i - 1], p) : null;
    const after = i + 1 < line.length ? normal(p, line[i + 1]) : null;
    const [u, v] = [before ?? after!, after ?? before!];
    const scale = right / Math.max(1 + u[0] * v[0] + u[1] * v[1], 0.5);
    return [p[0] + scale * (u[0] + v[0]), p[1] + scale * (u[1] + v[1])];
  });
}

/** The nearest place of a line: its distance along, and from, the line. */
export function along(line: Measured, at: Place): { x: number; distance: number } {
  let best = { x: NaN, distance: Infinity };
  for (let i = 1; i < line.x.length; ++i) {
    const [e, n] = [line.easting[i - 1], line.northing[i - 1]];
    const [de, dn] = [line.easting[i] - e, line.northing[i] - n];
    const f = Math.min(Math.max(((at[0] - e) * de + (at[1] - n) * dn) / (de * de + dn * dn || 1), 0), 1);
    const distance = Math.hypot(e + f * de - at[0], n + f * dn - at[1]);
    if (distance < best.distance) best = { x: line.x[i - 1] + f * (line.x[i] - line.x[i - 1]), distance };
  }
  return best;
}
