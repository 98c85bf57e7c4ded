// SPDX-License-Identifier: Apache-2.0
import uPlot from 'uplot';
import type { Chainage } from './chainage';
import type { Exceedance, StripInfo } from './contract';
import type { SeriesStore } from './pyramid';
import { css, limitStyle } from './theme';
import { minus } from './text';

export interface StripEvents {
  cursor(x: number | null): void;
  zoom(from: number, to: number): void;
}

/** One line of the strip chart: label on the left, drawing, value at the cursor on the right. */
export class Strip {
  readonly element: HTMLElement;
  private readonly value: HTMLElement;
  private readonly half: HTMLElement;
  private readonly box: HTMLElement;
  private plot: uPlot | null = null;
  private limitsScale = false;
  private busy = 0;

  constructor(
    readonly info: StripInfo,
    readonly store: SeriesStore,
    private readonly other: SeriesStore | null,
    private readonly chainage: Chainage,
    private readonly exceedances: Exceedance[],
    private readonly events: StripEvents,
  ) {
    this.element = document.createElement('section');
    this.element.className = 'strip';
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

  /** Makes the chart anew: at the start, on resize and when the theme changes. */
  build(width: number, height: number, from: number, to: number, last: boolean): void {
    this.plot?.destroy();
    const line = css('--line');
    const axis = { stroke: css('--muted'), font: '11px system-ui, sans-serif' };
    const hidden = { stroke: 'transparent', points: { show: false }, width: 0 };
    const drawn = { stroke: line, points: { show: false }, width: 1, spanGaps: false };
    const compared = { stroke: css('--compare'), points: { show: false }, width: 1, dash: [4, 3] };
    this.plot = new uPlot(
      {
        width,
        height: height + (last ? 26 : 0),
        padding: [2, 0, 2, 0],
        legend: { show: false },
        cursor: {
          y: false,
          drag: { x: true, y: false, setScale: false },
          sync: { key: 'versine', setSeries: false },
          points: { show: false },
        },
        scales: { x: { time: false, min: from, max: to }, y: { range: (_u, low, high) => this.range(low, high) } },
        series: [{}, hidden, hidden, drawn, drawn, compared],
        bands: [
          { series: [2, 1], fill: css('--band') },
          { series: [4, 3], fill: line },
        ],
        axes: [
          last
            ? { ...axis, size: 26, grid: { stroke: css('--grid') }, ticks: { show: false }, space: 110, values: (_u, v) => v.map((x) => this.chainage.text(x)) }
            : { show: false },
          { ...axis, size: 44, gap: 4, space: 18, grid: { stroke: css('--grid'), width: 1 }, ticks: { size: 4, stroke: css('--grid') }, values: (_u, v) => v.map((y) => minus(y)) },
        ],
        hooks: {
          drawClear: [(u) => this.drawLimits(u)],
          draw: [(u) => this.drawMarks(u)],
          setCursor: [(u) => u.cursor.event && this.events.cursor(u.cursor.left! < 0 ? null : u.posToVal(u.cursor.left!, 'x'))],
          setSelect: [
            (u) => {
              if (u.select.width < 4) return;
              this.events.zoom(u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x'));
              u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            },
          ],
        },
      },
      [[], [], [], [], [], []] as unknown as uPlot.AlignedData,
      this.box,
    );
  }

  async show(from: number, to: number): Promise<void> {
    if (!this.plot) return;
    if (this.store.whole && (this.other === null || this.other.whole)) {
      this.set(this.store.viewNow(from, to), this.other?.viewNow(from, to) ?? null, from, to);
      return;
    }
    const turn = ++this.busy;
    const [mine, theirs] = await Promise.all([this.store.view(from, to), this.other?.view(from, to) ?? null]);
    if (turn === this.busy) this.set(mine, theirs, from, to);
  }

  setLimitsScale(on: boolean): void {
    this.limitsScale = on;
    this.plot?.redraw(true, true);
  }

  /** A line for the cursor, and the value beside the strip with its 95 % interval and the limit it is over. */
  showCursor(x: number | null): string {
    const at = x === null ? null : this.store.at(x);
    if (!at || !Number.isFinite(at.value)) {
      this.value.textContent = '–';
      this.half.textContent = '';
      this.value.className = '';
      return '';
    }
    const over = [...this.info.limits]
      .reverse()
      .find((l) => (l.high !== null && at.value > l.high) || (l.low !== null && at.value < l.low));
    const number = minus(at.value, this.info.digits);
    const half = Number.isFinite(at.half) ? `± ${at.half.toFixed(this.info.digits)} ${this.info.unit}` : this.info.unit;
    this.value.textContent = over ? `${limitStyle[over.class].glyph} ${number}` : number;
    this.value.className = over ? `over-${over.class}` : '';
    this.half.textContent = half;
    return `${this.info.title} ${number} ${half}${over ? `, over the ${limitStyle[over.class].name}` : ''}`;
  }

  /** Puts the crosshair at a distance without the mouse. */
  moveCursor(x: number | null): void {
    if (!this.plot) return;
    this.plot.setCursor({ left: x === null ? -10 : this.plot.valToPos(x, 'x'), top: 4 }, false);
  }

  get canvas(): HTMLCanvasElement | null {
    return this.plot?.ctx.canvas ?? null;
  }

  destroy(): void {
    this.plot?.destroy();
    this.plot = null;
  }

  private set(mine: { x: Float64Array; min: Float32Array; max: Float32Array; lower: Float32Array | null; upper: Float32Array | null }, theirs: { x: Float64Array; min: Float32Array } | null, from: number, to: number): void {
    const empty = new Float32Array(mine.x.length).fill(NaN);
    const nulls = (a: ArrayLike<number>) => Array.from(a, (v) => (Number.isFinite(v) ? v : null));
    let compared: (number | null)[] = nulls(empty);
    if (theirs) {
      // The other run has places of its own: take its value at or before each of ours.
      let k = 0;
      compared = Array.from(mine.x, (x) => {
        while (k + 1 < theirs.x.length && theirs.x[k + 1] <= x) ++k;
        const v = theirs.min[k];
        return Number.isFinite(v) && Math.abs(theirs.x[k] - x) < (to - from) / 200 ? v : null;
      });
    }
    const single = mine.min === mine.max || mine.x.length < 2;
    this.plot!.batch(() => {
      this.plot!.setData(
        [Array.from(mine.x), nulls(mine.lower ?? empty), nulls(mine.upper ?? empty), nulls(mine.min), single ? nulls(mine.min) : nulls(mine.max), compared] as uPlot.AlignedData,
        false,
      );
      this.plot!.setScale('x', { min: from, max: to });
    });
  }

  private range(low: number | null, high: number | null): [number, number] {
    let a = low ?? -1;
    let b = high ?? 1;
    if (this.limitsScale) {
      for (const limit of this.info.limits) {
        if (limit.low !== null) a = Math.min(a, limit.low);
        if (limit.high !== null) b = Math.max(b, limit.high);
      }
    }
    if (!(b > a)) [a, b] = [a - 1, b + 1];
    const margin = 0.08 * (b - a);
    return [a - margin, b + margin];
  }

  private drawLimits(u: uPlot): void {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const limit of this.info.limits) {
      const style = limitStyle[limit.class];
      ctx.strokeStyle = css(style.color);
      ctx.lineWidth = devicePixelRatio;
      ctx.setLineDash(style.dash.map((d) => d * devicePixelRatio));
      for (const y of [limit.low, limit.high]) {
        if (y === null) continue;
        const at = Math.round(u.valToPos(y, 'y', true));
        ctx.beginPath();
        ctx.moveTo(bbox.left, at);
        ctx.lineTo(bbox.left + bbox.width, at);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  private drawMarks(u: uPlot): void {
    const { ctx, bbox } = u;
    const [from, to] = [u.scales.x.min!, u.scales.x.max!];
    ctx.save();
    ctx.strokeStyle = css('--muted');
    ctx.lineWidth = devicePixelRatio;
    for (const jump of this.chainage.jumps()) {
      if (jump.x < from || jump.x > to) continue;
      for (const offset of [-1.5, 1.5]) {
        const x = u.valToPos(jump.x, 'x', true) + offset * devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(x, bbox.top);
        ctx.lineTo(x, bbox.top + bbox.height);
        ctx.stroke();
      }
    }
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    for (const e of this.exceedances) {
      if (e.peakAt < from || e.peakAt > to) continue;
      ctx.fillStyle = css(limitStyle[e.class].color);
      const y = Math.min(Math.max(u.valToPos(e.peak, 'y', true), bbox.top + 5), bbox.top + bbox.height - 5);
      ctx.fillText(limitStyle[e.class].glyph, u.valToPos(e.peakAt, 'x', true), y);
    }
    ctx.restore();
  }
}
