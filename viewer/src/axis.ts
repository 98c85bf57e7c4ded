// SPDX-License-Identifier: Apache-2.0

/** What the horizontal axis of all strips counts: places along a line, or time. */
export interface Axis {
  /** "km 16+104", "01:12:03": for the large readout and for speech. */
  readout(x: number, digits?: number): string;
  /** The same without its unit, for ticks and tables. */
  text(x: number, digits?: number): string;
  /** Every x that carries what a person typed; null when it could not be read. */
  find(typed: string): number[] | null;
  /** What to write to find one. */
  readonly example: string;
  readonly unit: string;
  /** Places where what is posted jumps. */
  jumps(): { x: number; label: string }[];
  /** Where ticks may stand: as many as fit at least `least` apart. */
  ticks(from: number, to: number, least: number): number[];
  /** The label of a tick among ticks so far apart. */
  tick(x: number, apart: number): string;
}

const pad = (value: number, width = 2) => String(value).padStart(width, '0');

/** Seconds since the start of a recording. */
export class TimeAxis implements Axis {
  readonly example = '0:12:30';
  readonly unit = 'h:min:s from the start';

  text(x: number, digits = 0): string {
    const scale = 10 ** digits;
    const rounded = Math.round(Math.max(x, 0) * scale) / scale;
    const whole = Math.floor(rounded);
    const rest = digits > 0 ? (rounded - whole).toFixed(digits).slice(1) : '';
    return `${Math.floor(whole / 3600)}:${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}${rest}`;
  }

  readout(x: number, digits = 0): string {
    return this.text(x, digits);
  }

  find(typed: string): number[] | null {
    const parts = typed.trim().split(':').map(Number);
    if (typed.trim() === '' || parts.length > 3 || parts.some((p) => !Number.isFinite(p))) return null;
    return [parts.reduce((sum, part) => 60 * sum + part, 0)];
  }

  jumps(): { x: number; label: string }[] {
    return [];
  }

  tick(x: number, apart: number): string {
    return this.text(x, apart < 0.95 ? 1 : 0);
  }

  ticks(from: number, to: number, least: number): number[] {
    const step = [1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 14400, 43200].find((s) => s >= least) ?? 86400;
    const out: number[] = [];
    for (let x = Math.ceil(from / step) * step; x <= to; x += step) out.push(x);
    return out;
  }
}
