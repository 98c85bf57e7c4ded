// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import type { ControlPoint, Exceedance } from './contract';
import { element } from './text';
import { css, limitStyle } from './theme';
import type { View } from './view';

const heights = { AL: 8, IL: 16, IAL: 28 };

/** The whole survey at the bottom: a tick a fault, and the window that can be dragged. */
export class Overview {
  readonly element = element('div', { class: 'overview', role: 'img', 'aria-label': 'Whole survey with exceedances; drag the window' });
  private readonly canvas = element('canvas');

  constructor(
    private readonly view: View,
    private readonly axis: Axis,
    private readonly exceedances: Exceedance[],
    private readonly control: ControlPoint[],
  ) {
    this.element.append(this.canvas);
    let grip = 0;
    const place = (event: PointerEvent) => {
      const box = this.canvas.getBoundingClientRect();
      return view.first + ((event.clientX - box.left) / box.width) * (view.last - view.first);
    };
    this.canvas.addEventListener('pointerdown', (event) => {
      const x = place(event);
      grip = x >= view.from && x <= view.to ? x - (view.from + view.to) / 2 : 0;
      this.canvas.setPointerCapture(event.pointerId);
      this.centre(x - grip);
    });
    this.canvas.addEventListener('pointermove', (event) => {
      if (this.canvas.hasPointerCapture(event.pointerId)) this.centre(place(event) - grip);
    });
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0) return;
    const ratio = devicePixelRatio;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const ctx = this.canvas.getContext('2d')!;
    ctx.scale(ratio, ratio);
    const at = (x: number) => ((x - this.view.first) / (this.view.last - this.view.first)) * width;
    const base = height - 20;
    ctx.fillStyle = css('--window');
    ctx.strokeStyle = css('--line');
    const left = at(this.view.from);
    const wide = Math.max(at(this.view.to) - left, 3);
    ctx.fillRect(left, 3, wide, base - 3);
    ctx.strokeRect(left + 0.5, 3.5, wide, base - 4);
    for (const e of this.exceedances) {
      ctx.fillStyle = css(limitStyle[e.class].color);
      ctx.fillRect(at(e.peakAt) - 1, base - heights[e.class], 2, heights[e.class]);
    }
    ctx.fillStyle = css('--cursor');
    ctx.fillRect(at(this.view.cursor), 3, 1, base - 3);
    ctx.fillStyle = css('--muted');
    ctx.fillRect(0, base, width, 1);
    ctx.font = '12px system-ui, sans-serif';
    ctx.textAlign = 'center';
    for (const c of this.control) ctx.fillRect(at(c.x), base, 1, 4);
    const span = this.view.last - this.view.first;
    const ticks = this.axis.ticks(this.view.first, this.view.last, (span * 100) / width);
    for (const x of ticks) ctx.fillText(this.axis.tick(x, ticks.length > 1 ? ticks[1] - ticks[0] : 1), Math.min(Math.max(at(x), 24), width - 24), height - 4);
  }

  private centre(x: number): void {
    const half = (this.view.to - this.view.from) / 2;
    this.view.cursor = Math.min(Math.max(x, this.view.first), this.view.last);
    this.view.zoom(x - half, x + half);
  }
}
