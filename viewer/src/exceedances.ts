// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import type { Exceedance } from './contract';
import { element, minus, percent } from './text';
import { limitStyle } from './theme';

const severity = { AL: 1, IL: 2, IAL: 3 };
const mostRows = 1000; // beyond, a table is no help to anyone
const eventLength = 15; // m: exceedances nearer than this are one event

/** Events by place with the worst first; inside an event again the worst first. */
export function ordered(list: Exceedance[]): { exceedance: Exceedance; nested: boolean }[] {
  const events: Exceedance[][] = [];
  for (const e of [...list].sort((a, b) => a.peakAt - b.peakAt)) {
    const last = events[events.length - 1];
    if (last && e.peakAt - last[last.length - 1].peakAt <= eventLength) last.push(e);
    else events.push([e]);
  }
  const worse = (a: Exceedance, b: Exceedance) =>
    severity[b.class] - severity[a.class] || (b.probability ?? 0) - (a.probability ?? 0) || a.peakAt - b.peakAt;
  for (const event of events) event.sort(worse);
  events.sort((a, b) => worse(a[0], b[0]));
  return events.flatMap((event) => event.map((exceedance, i) => ({ exceedance, nested: i > 0 })));
}

/** The list of faults: a real table, walked with N and B. */
export class ExceedanceTable {
  readonly element = element('section', { class: 'exceedances' });
  readonly rows: { exceedance: Exceedance; row: HTMLTableRowElement }[] = [];
  private current = -1;

  constructor(
    list: Exceedance[],
    axis: Axis,
    private readonly select: (e: Exceedance) => void,
  ) {
    this.element.append(element('h2', {}, `Exceedances (${list.length})${list.length > mostRows ? `, the worst ${mostRows}` : ''} · N / B to step`));
    if (list.length === 0) {
      this.element.append(element('p', { class: 'empty' }, 'No limit is exceeded, or none was given.'));
      return;
    }
    const table = element('table');
    table.append(element('caption', { class: 'visually-hidden' }, 'Exceedances by place, the worst first'));
    const head = table.createTHead().insertRow();
    for (const name of ['Class', 'Place', 'Parameter', 'Peak', 'Over']) head.append(element('th', { scope: 'col' }, name));
    const body = table.createTBody();
    for (const { exceedance, nested } of ordered(list)) {
      if (this.rows.length === mostRows) break;
      const row = body.insertRow();
      row.className = `class-${exceedance.class}`;
      const style = limitStyle[exceedance.class];
      const link = element('button', { type: 'button' }, `${nested ? '↳ ' : ''}${axis.text(exceedance.peakAt)}`);
      if (nested) row.classList.add('nested');
      link.addEventListener('click', () => this.goTo(this.rows.findIndex((r) => r.row === row)));
      row.append(element('th', { scope: 'row', title: `${exceedance.level}, drawn as ${style.name}` }, `${style.glyph} ${exceedance.level.length > 4 ? `${exceedance.level.slice(0, 3)}.` : exceedance.level}`));
      row.insertCell().append(link);
      row.insertCell().textContent = exceedance.title;
      row.cells[2].title = exceedance.note;
      const peak = row.insertCell();
      peak.textContent = minus(exceedance.peak, exceedance.digits);
      peak.title = exceedance.sigma === null ? exceedance.unit : `± ${(1.96 * exceedance.sigma).toFixed(exceedance.digits + 1)} ${exceedance.unit}`;
      const over = row.insertCell();
      over.textContent = percent(exceedance.probability);
      over.title = 'probability that the limit is exceeded';
      this.rows.push({ exceedance, row });
    }
    const scroll = element('div', { class: 'scroll', tabindex: '0', 'aria-label': 'Exceedances' });
    scroll.append(table);
    this.element.append(scroll);
  }

  step(by: 1 | -1): void {
    if (this.rows.length > 0) this.goTo((this.current + by + this.rows.length) % this.rows.length);
  }

  private goTo(index: number): void {
    this.rows[this.current]?.row.removeAttribute('aria-current');
    this.current = index;
    const { exceedance, row } = this.rows[index];
    row.setAttribute('aria-current', 'true');
    row.scrollIntoView({ block: 'nearest' });
    this.select(exceedance);
  }
}
