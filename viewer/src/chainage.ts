// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import type { ChainagePiece } from './contract';
import { minus } from './text';

/** "16+104" for 16,104 m; digits are those of the metres. */
export function kmText(posted: number, digits = 0): string {
  const scale = 10 ** digits;
  const rounded = Math.round(Math.abs(posted) * scale) / scale;
  const km = Math.floor(rounded / 1000);
  const m = (rounded - 1000 * km).toFixed(digits);
  const width = digits > 0 ? 4 + digits : 3;
  return `${posted < 0 && rounded > 0 ? '-' : ''}${km}+${m.padStart(width, '0')}`;
}

/** Between continuous track distance, which every drawing uses, and posted kilometres, which people read and type. */
export class Chainage implements Axis {
  readonly example = '16+104';
  readonly unit = 'km';

  constructor(private readonly pieces: ChainagePiece[]) {}

  posted(x: number): number {
    const p = this.pieces.find((piece) => x <= piece.to) ?? this.pieces[this.pieces.length - 1];
    return p ? p.posted + p.sign * (x - p.from) : x;
  }

  text(x: number, digits = 0): string {
    return kmText(this.posted(x), digits);
  }

  readout(x: number, digits = 0): string {
    return `km ${this.text(x, digits)}`;
  }

  tick(x: number, apart: number): string {
    return apart > 995 ? `km ${Math.round(this.posted(x + 1e-6) / 1000)}` : this.text(x + 1e-6, apart < 0.95 ? 1 : 0);
  }

  find(typed: string): number[] | null {
    const posted = Chainage.parse(typed);
    return posted === null ? null : this.places(posted);
  }

  /** Round posted values, piece by piece: none is drawn twice where kilometres overlap by a jump. */
  ticks(from: number, to: number, least: number): number[] {
    const step = [0.1, 0.2, 0.5].concat([1, 10, 100, 1000, 10000].flatMap((s) => [s, 2 * s, 5 * s])).find((s) => s >= least) ?? 100000;
    const out: number[] = [];
    for (const p of this.pieces.length > 0 ? this.pieces : [{ from, to, posted: from, sign: 1 as const }]) {
      const [a, b] = [Math.max(from, p.from), Math.min(to, p.to)];
      if (!(b > a)) continue;
      const [low, high] = [this.posted(a + 1e-9), p.posted + p.sign * (b - p.from)].sort((u, v) => u - v);
      for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9; ++k) {
        const x = p.from + p.sign * (k * step - p.posted);
        if (out.length === 0 || x - out[out.length - 1] > 0.6 * least) out.push(x);
      }
    }
    return out;
  }

  /** Every place where a posted kilometre occurs: none, one, or several where kilometres are posted twice. */
  places(posted: number): number[] {
    if (this.pieces.length === 0) return [posted];
    return this.pieces
      .map((p) => ({ x: p.from + p.sign * (posted - p.posted), p }))
      .filter(({ x, p }) => x >= p.from - 1e-6 && x <= p.to + 1e-6)
      .map(({ x }) => x);
  }

  /** Jumps with their labels, "18+215 = 18+200, -15 m". */
  jumps(): { x: number; label: string }[] {
    const all = this.pieces.slice(1).map((next, i) => {
      const last = this.pieces[i];
      const before = last.posted + last.sign * (last.to - last.from);
      const difference = Math.round(1000 * (next.posted - before)) / 1000;
      const sign = difference > 0 ? '+' : '';
      const digits = Number.isInteger(Math.round(1000 * before) / 1000) ? 0 : 1;
      return { x: next.from, label: `${kmText(before, digits)} = ${kmText(next.posted, digits)}, ${sign}${minus(difference)} m`, difference };
    });
    return all.filter((jump) => jump.difference !== 0);
  }

  /** Reads "16+104", "16.104" (km) or "16104" (m). */
  static parse(text: string): number | null {
    const plus = /^\s*(-?\d+)\s*\+\s*(\d+(?:[.,]\d+)?)\s*$/.exec(text);
    if (plus) {
      const km = Number(plus[1]);
      return 1000 * km + (km < 0 || plus[1].startsWith('-') ? -1 : 1) * Number(plus[2].replace(',', '.'));
    }
    const plain = /^\s*(-?\d+)(?:[.,](\d+))?\s*$/.exec(text);
    if (!plain) return null;
    return plain[2] === undefined ? Number(plain[1]) : 1000 * Number(`${plain[1]}.${plain[2]}`);
  }
}
