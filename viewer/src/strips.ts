// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import type { Axis } from './axis';
import type { Exceedance, Series, StripInfo } from './contract';
import { drawBand, drawLine, drawValues, type Frame } from './draw';
import type { SeriesStore } from './pyramid';
import { minus } from './text';
import { css, limitStyle } from './theme';

export interface StripEvents {
  cursor(x: number): void;
  zoom(from: number, to: number): void;
}

export const labelWidth = 172;
export const valueWidth = 116;
export const scaleWidth = 44;
export const rightPadding = 26; // of a drawing: half of a label on the last tick
const axisHeight = 26;

/** A value at the cursor, with its standard deviation or NaN. */
export interface Reading {
  value: number;
  sigma: number;
}

/** What a strip draws besides its own series. */
export interface Extras {
  compare: SeriesStore | null; // another run's values on the same scale
  companion: SeriesStore | null; // another quantity on its own scale
}

/** The number that stood in the file: seven digits survive single precision, and rounding must start from them. */
const written = (value: number) => Number(value.toPrecision(7));

/** What is on the strip now. */
interface Drawn {
  mine: Series;
  compare: Series | null;
  companion: Series | null;
}

/** Smallest and largest value, of the 95 % band where there is one. */
function extent(...all: (Series | null)[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const series of all) {
    if (!series) continue;
    const [lower, upper] = [series.lower ?? series.min, series.upper ?? series.max];
    for (let i = 0; i < lower.length; ++i) {
      if (lower[i] < low) low = lower[i];
      if (upper[i] > high) high = upper[i];
    }
  }
  return high >= low ? [low, high] : [0, 0];
}

/** One line of the strip chart: label on the left, drawing, value at the cursor on the right. */
export class Strip {
  readonly element: HTMLElement;
  private readonly value: HTMLElement;
  private readonly half: HTMLElement;
  private readonly box: HTMLElement;
  private plot: uPlot | null = null;
  private limitsScale = false;
  private drawn: Drawn | null = null;
  private turn = 0;

  constructor(
    readonly info: StripInfo,
    readonly store: SeriesStore,
    private readonly extras: Extras,
    private readonly axis: Axis,
    private readonly exceedances: Exceedance[],
    private readonly events: StripEvents,
  ) {
    this.element = document.createElement('section');
    this.element.className = 'strip';
    this.element.dataset.strip = info.id;
    this.element.setAttribute('aria-label', `${info.title}, ${info.note}, ${info.unit}, ${info.positive}`);
    this.element.innerHTML = `
      <div class="strip-label"><b></b><span></span><span></span></div>
      <div class="strip-box"></div>
      <div class="strip-value"><output></output><span></span></div>`;
    const [title, note, sign] = this.element.querySelectorAll('.strip-label > *');
    title.textContent = info.title;
    note.textContent = [info.note, info.unit].filter(Boolean).join(' · ');
    sign.textContent = info.positive;
    this.box = this.element.querySelector('.strip-box')!;
    this.value = this.element.querySelector('output')!;
    this.half = this.element.querySelector('.strip-value span')!;
  }

  get stores(): SeriesStore[] {
    return [this.store, this.extras.compare, this.extras.companion].filter((s) => s !== null);
  }

  /** Makes the chart anew: at the start, on resize and when the theme changes. */
  build(width: number, height: number, from: number, to: number, last: boolean): void {
    this.plot?.destroy();
    this.element.style.height = `${height + (last ? axisHeight : 0)}px`;
    this.plot = new uPlot(this.options(width, height + (last ? axisHeight : 0) - 1, from, to, last), [[from, to], [null, null]], this.box);
  }

  private options(width: number, height: number, from: number, to: number, last: boolean): uPlot.Options {
    const ticks = { stroke: css('--muted'), font: '12px system-ui, sans-serif', ticks: { show: false } };
    const grid = { stroke: css('--grid'), width: 1 };
    return {
      width,
      height,
      padding: [3, rightPadding, 3, 0],
      legend: { show: false },
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { show: false } },
      scales: {
        x: { time: false, min: from, max: to },
        y: { auto: false, range: [-1, 1] },
      },
      series: [{}, { paths: () => null, points: { show: false } }], // drawn by drawSeries
      axes: [
        {
          ...ticks,
          size: last ? axisHeight : 0,
          gap: 6,
          grid,
          splits: (_u, _i, low, high) => this.axis.ticks(low, high, ((high - low) * 110) / Math.max(width, 1)),
          values: (u, v) => v.map((x) => (last && !this.underJump(u, x) ? this.axis.tick(x, v.length > 1 ? v[1] - v[0] : 1) : '')),
        },
        { ...ticks, size: scaleWidth, gap: 6, space: 12, grid, values: (u, v) => v.map((y) => (this.nearEdge(u, y) ? '' : minus(y))) },
      ],
      hooks: {
        drawClear: [(u) => this.drawLimits(u)],
        draw: [(u) => this.drawSeries(u), (u) => this.drawMarks(u, last)],
        setCursor: [(u) => u.cursor.event && u.cursor.left! >= 0 && this.events.cursor(u.posToVal(u.cursor.left!, 'x'))],
        setSelect: [
          (u) => {
            if (u.select.width < 4) return;
            this.events.zoom(u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x'));
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          },
        ],
      },
    };
  }

  /** Draws a stretch: at once from memory, else when the server has answered, the latest question alone. */
  async show(from: number, to: number): Promise<void> {
    const turn = ++this.turn;
    if (this.stores.every((s) => s.loaded)) {
      this.set({ mine: this.store.now(from, to), compare: this.extras.compare?.now(from, to) ?? null, companion: this.extras.companion?.now(from, to) ?? null }, from, to);
      return;
    }
    const [mine, compare, companion] = await Promise.all([this.store, this.extras.compare, this.extras.companion].map((s) => s?.fetch(from, to) ?? null));
    if (turn === this.turn) this.set({ mine: mine!, compare, companion }, from, to);
  }

  setLimitsScale(on: boolean): void {
    this.limitsScale = on;
    if (this.plot && this.drawn) this.set(this.drawn, this.plot.scales.x.min!, this.plot.scales.x.max!);
  }

  /** The value beside the strip with its 95 % interval and the limit it is over; returns what to say. */
  showReading(sample: Reading | null, companion: Reading | null): string {
    const { digits, unit, title } = this.info;
    const reading = sample && { value: written(sample.value), sigma: written(sample.sigma) };
    if (!reading || !Number.isFinite(reading.value)) {
      this.value.textContent = '–';
      this.half.textContent = '';
      this.value.className = '';
      return '';
    }
    const over = [...this.info.limits]
      .reverse()
      .find((l) => (l.high !== null && reading.value > l.high) || (l.low !== null && reading.value < l.low));
    // Where the 95 % interval is finer than the last digit, one digit more.
    const half = 1.96 * reading.sigma;
    const places = digits + (half < 0.6 * 10 ** -digits ? 1 : 0);
    const number = minus(reading.value, places);
    const interval = Number.isFinite(half) ? `± ${half.toFixed(places)} ${unit}` : unit;
    let second = interval;
    this.value.textContent = over ? `${limitStyle[over.class].glyph} ${number}` : number;
    this.value.title = `${reading.value} ${unit}${Number.isFinite(reading.sigma) ? `, sigma ${reading.sigma}` : ''}`;
    this.value.className = over ? `over-${over.class}` : '';
    if (this.info.companion && companion) {
      const radius = 1000 / Math.abs(reading.value);
      this.value.textContent = Math.abs(reading.value) < 2 * half || radius > 30000 ? 'straight' : `R ${radius < 10000 ? Math.round(radius) : `${Math.round(radius / 1000)} km`}`;
      const side = this.value.textContent === 'straight' ? '' : reading.value > 0 ? 'right · ' : 'left · ';
      second = `${side}${this.info.companion.title} ${minus(companion.value, 0)}${side ? '' : ` ${this.info.companion.unit}`}`;
    }
    this.half.textContent = second;
    return `${title} ${number} ${interval}${over ? `, over the ${over.level}` : ''}`;
  }

  /** Puts the crosshair at a place without the mouse. */
  moveCursor(x: number): void {
    if (!this.plot) return;
    const left = this.plot.valToPos(x, 'x');
    this.plot.setCursor({ left: left >= 0 && left <= this.plot.over.clientWidth ? left : -10, top: 4 }, false);
  }

  get canvas(): HTMLCanvasElement | null {
    return this.plot?.ctx.canvas ?? null;
  }

  destroy(): void {
    this.plot?.destroy();
    this.plot = null;
  }

  private set(drawn: Drawn, from: number, to: number): void {
    if (!this.plot) return;
    this.drawn = drawn;
    const [min, max] = this.range(...extent(drawn.mine, drawn.compare));
    this.plot.batch((plot: uPlot) => {
      plot.setScale('x', { min: from, max: to });
      plot.setScale('y', { min, max });
    });
  }

  private range(low: number, high: number): [number, number] {
    let [a, b] = [low, high];
    // Noise is not blown up to look like a fault: at least a few times the last digit shown.
    const least = 20 * 10 ** -this.info.digits;
    if (this.limitsScale && this.info.limits.length > 0) {
      // The mildest limit is always seen; the others as soon as the values come near.
      const { low: lowest, high: highest } = this.info.limits[0];
      if (lowest !== null) a = Math.min(a, 1.05 * lowest);
      if (highest !== null) b = Math.max(b, 1.05 * highest);
    }
    return padded(a, b, least);
  }

  private drawSeries(u: uPlot): void {
    if (!this.drawn) return;
    const { mine, compare, companion } = this.drawn;
    const { ctx, bbox } = u;
    const { x, y } = u.scales;
    const frame: Frame = { left: bbox.left, top: bbox.top, width: bbox.width, height: bbox.height, from: x.min!, to: x.max!, low: y.min!, high: y.max! };
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineJoin = 'bevel';
    ctx.fillStyle = css('--band');
    drawBand(ctx, frame, mine);
    ctx.fillStyle = ctx.strokeStyle = css('--line');
    drawValues(ctx, frame, mine, ratio);
    if (compare) {
      ctx.strokeStyle = css('--compare');
      ctx.setLineDash([4 * ratio, 3 * ratio]);
      drawLine(ctx, frame, compare.x, compare.min, ratio);
    }
    if (companion) {
      const [low, high] = padded(...extent({ ...companion, lower: null, upper: null }), 1);
      ctx.strokeStyle = css('--companion');
      ctx.setLineDash([6 * ratio, 3 * ratio]);
      drawLine(ctx, { ...frame, low, high }, companion.x, companion.min, ratio);
    }
    ctx.restore();
  }

  private drawLimits(u: uPlot): void {
    const { ctx, bbox } = u;
    const { min, max } = u.scales.y;
    if (min === undefined || min === null || max === undefined || max === null) return;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const limit of this.info.limits) {
      const style = limitStyle[limit.class];
      ctx.strokeStyle = css(style.color);
      ctx.fillStyle = css(`${style.color}-zone`);
      ctx.lineWidth = devicePixelRatio;
      ctx.setLineDash(style.dash.map((d) => d * devicePixelRatio));
      for (const [value, outward] of [[limit.low, bbox.top + bbox.height], [limit.high, bbox.top]] as const) {
        if (value === null || value < min || value > max) continue;
        const at = Math.round(u.valToPos(value, 'y', true)) + 0.5;
        ctx.fillRect(bbox.left, Math.min(at, outward), bbox.width, Math.abs(outward - at));
        ctx.beginPath();
        ctx.moveTo(bbox.left, at);
        ctx.lineTo(bbox.left + bbox.width, at);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  private drawMarks(u: uPlot, last: boolean): void {
    const { ctx, bbox } = u;
    const [from, to] = [u.scales.x.min!, u.scales.x.max!];
    ctx.save();
    ctx.strokeStyle = css('--muted');
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([2 * devicePixelRatio, 2 * devicePixelRatio]);
    for (const jump of this.axis.jumps()) {
      if (jump.x < from || jump.x > to) continue;
      for (const offset of [-1.5, 1.5]) {
        const x = u.valToPos(jump.x, 'x', true) + offset * devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
      }
    }
    ctx.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    if (last) this.labelJumps(u);
    for (const e of this.exceedances) {
      if (e.peakAt < from || e.peakAt > to) continue;
      ctx.fillStyle = css(limitStyle[e.class].color);
      const y = Math.min(Math.max(u.valToPos(e.peak, 'y', true), bbox.top + 6 * devicePixelRatio), bbox.top + bbox.height - 6 * devicePixelRatio);
      ctx.fillText(limitStyle[e.class].glyph, u.valToPos(e.peakAt, 'x', true), y);
    }
    ctx.restore();
  }

  /** Half a label would be cut off. */
  private nearEdge(u: uPlot, y: number): boolean {
    const at = u.valToPos(y, 'y');
    return at < 4 || at > u.bbox.height / devicePixelRatio - 4;
  }

  /** A tick whose label would stand under that of a jump. */
  private underJump(u: uPlot, x: number): boolean {
    return this.axis.jumps().some((jump) => Math.abs(u.valToPos(x, 'x') - u.valToPos(jump.x, 'x')) < 115);
  }

  /** "18+215 = 18+200, -15 m" over the ticks below a jump, where there is room. */
  private labelJumps(u: uPlot): void {
    const { ctx, bbox } = u;
    let free = bbox.left;
    for (const jump of this.axis.jumps()) {
      const x = u.valToPos(jump.x, 'x', true);
      const half = ctx.measureText(jump.label).width / 2 + 8 * devicePixelRatio;
      if (x - half < free || x < bbox.left || x > bbox.left + bbox.width) continue;
      const middle = Math.min(x, u.ctx.canvas.width - half);
      ctx.fillStyle = css('--background');
      ctx.fillRect(middle - half, bbox.top + bbox.height + 2, 2 * half, ctx.canvas.height);
      ctx.fillStyle = css('--text');
      ctx.fillText(jump.label, middle, bbox.top + bbox.height + 14 * devicePixelRatio);
      free = middle + half;
    }
  }
}

function padded(low: number, high: number, least: number): [number, number] {
  let [a, b] = [low, high];
  if (!(b - a >= least)) {
    const middle = (a + b) / 2;
    [a, b] = [middle - least / 2, middle + least / 2];
  }
  const margin = 0.08 * (b - a);
  return [a - margin, b + margin];
}
