// SPDX-License-Identifier: Apache-2.0
import type { Journey, Stretch } from './contract';
import { rightPadding, scaleWidth } from './strips';
import { element, percent } from './text';
import { css } from './theme';

/** What shares of probability the alternatives have between two places; path 1 has the rest. */
export interface Share {
  from: number;
  to: number;
  stretches: Stretch[];
}

/** Pieces of [first, last] with the stretches that cover each. */
export function shares(stretches: Stretch[], ends: (s: Stretch) => [number, number], first: number, last: number): Share[] {
  const cuts = [first, last, ...stretches.flatMap(ends)].filter((x) => x >= first && x <= last).sort((a, b) => a - b);
  const out: Share[] = [];
  for (let i = 1; i < cuts.length; ++i) {
    if (!(cuts[i] > cuts[i - 1])) continue;
    const middle = (cuts[i] + cuts[i - 1]) / 2;
    out.push({ from: cuts[i - 1], to: cuts[i], stretches: stretches.filter((s) => ends(s)[0] <= middle && middle <= ends(s)[1]) });
  }
  return out;
}

/** The probability of the track that path 1 is on, and above it that of each alternative, as a stacked area. */
export class ProbabilityStrip {
  readonly element = element('section', { class: 'strip', 'data-strip': 'probability', 'aria-label': 'Probability of the track' });
  private readonly canvas = element('canvas', { role: 'img', 'aria-label': 'Probability of path 1 and of its alternatives' });
  private readonly box = element('div', { class: 'strip-box' });
  private readonly value = element('output');
  private readonly half = element('span');
  private pieces: Share[] = [];

  constructor(journey: Journey, ends: (s: Stretch) => [number, number], first: number, last: number, go: (x: number) => void) {
    const label = element('div', { class: 'strip-label' });
    label.append(element('b', {}, 'Probability'), element('span', {}, 'of the track, paths stacked'));
    this.box.append(this.canvas);
    const right = element('div', { class: 'strip-value' });
    right.append(this.value, this.half);
    this.element.append(label, this.box, right);
    this.pieces = shares(journey.stretches, ends, first, last);
    this.canvas.addEventListener('click', (event) => {
      const { left, width } = this.canvas.getBoundingClientRect();
      go(this.from + ((event.clientX - left - scaleWidth) / (width - scaleWidth - rightPadding)) * (this.to - this.from));
    });
  }

  private from = 0;
  private to = 1;

  /** `width` is that of the strips' drawings, so that one cursor line goes through all of them. */
  draw(from: number, to: number, cursor: number, width: number, height: number): string {
    [this.from, this.to] = [from, to];
    this.element.style.height = `${height}px`;
    const ratio = devicePixelRatio;
    [this.canvas.width, this.canvas.height] = [width * ratio, (height - 1) * ratio];
    Object.assign(this.canvas.style, { width: `${width}px`, height: `${height - 1}px`, display: 'block' });
    const ctx = this.canvas.getContext('2d')!;
    ctx.scale(ratio, ratio);
    const [top, bottom] = [4, height - 5];
    const x = (place: number) => scaleWidth + ((place - from) / (to - from)) * (width - scaleWidth - rightPadding);
    const y = (p: number) => bottom - p * (bottom - top);
    ctx.beginPath();
    ctx.rect(scaleWidth, 0, width - scaleWidth - rightPadding, height);
    ctx.save();
    ctx.clip();
    for (const piece of this.pieces) if (piece.to > from && piece.from < to) this.drawPiece(ctx, piece, x, y);
    ctx.strokeStyle = css('--cursor');
    ctx.setLineDash([3, 3]);
    ctx.beginPath();
    ctx.moveTo(x(cursor), top);
    ctx.lineTo(x(cursor), bottom);
    ctx.stroke();
    ctx.restore();
    ctx.fillStyle = css('--muted');
    ctx.font = '12px system-ui, sans-serif';
    ctx.textAlign = 'right';
    ctx.fillText('1', scaleWidth - 6, top + 9);
    ctx.fillText('0', scaleWidth - 6, bottom);
    return this.read(cursor);
  }

  private drawPiece(ctx: CanvasRenderingContext2D, piece: Share, x: (place: number) => number, y: (p: number) => number): void {
    const [a, b] = [x(piece.from), x(piece.to)];
    let base = 1 - piece.stretches.reduce((sum, s) => sum + s.probability, 0);
    ctx.fillStyle = css('--band');
    ctx.fillRect(a, y(base), b - a, y(0) - y(base));
    ctx.strokeStyle = css('--line');
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.moveTo(a, y(base));
    ctx.lineTo(b, y(base));
    ctx.stroke();
    for (const s of piece.stretches) {
      ctx.fillStyle = css('--alternative');
      ctx.fillRect(a, y(base + s.probability), b - a, y(base) - y(base + s.probability));
      if (b - a > 14 && y(base) - y(base + s.probability) > 11) {
        ctx.fillStyle = css('--text');
        ctx.font = 'bold 12px system-ui, sans-serif';
        ctx.textAlign = 'center';
        ctx.fillText(String(s.paths[0] ?? ''), (a + b) / 2, (y(base) + y(base + s.probability)) / 2 + 4);
      }
      base += s.probability;
    }
  }

  private read(cursor: number): string {
    const here = this.pieces.find((p) => cursor >= p.from && cursor <= p.to);
    const other = here?.stretches.reduce((sum, s) => sum + s.probability, 0) ?? 0;
    this.value.textContent = percent(1 - other);
    this.half.textContent = here && here.stretches.length > 0 ? here.stretches.map((s) => `${s.paths[0]}: ${percent(s.probability)}`).join(' ') : 'path 1';
    return `track of path 1 ${this.value.textContent}`;
  }
}
