// SPDX-License-Identifier: Apache-2.0
import type { Evidence, Journey, Stretch } from './contract';
import type { Review } from './review';
import { element, minus, percent, shortName } from './text';

export interface Case {
  journey: Journey;
  stretch: Stretch;
}

const names: Record<keyof Evidence, string> = { position: 'fixes', speed: 'speeds', turn_rate: 'turn rate', route: 'route' };

/** The part of the evidence that speaks loudest, and how loud, in words. */
export function deciding(evidence: Evidence): string {
  const parts = (Object.entries(evidence) as [keyof Evidence, number][]).filter(([, v]) => Number.isFinite(v) && Math.abs(v) > 0.05);
  if (parts.length === 0) return 'nothing tells them apart';
  parts.sort((a, b) => Math.abs(b[1]) - Math.abs(a[1]));
  return parts.map(([name, value]) => `${names[name]} ${value > 0 ? 'for' : 'against'} 1 by ${minus(Math.abs(value), 1)}`).join(', ');
}

/** Ambiguous stretches of all journeys, least certain first: a real table, walked with N and B. */
export class StretchTable {
  readonly element = element('section', { class: 'stretches', 'aria-label': 'Ambiguous stretches' });
  private readonly cases: Case[];
  private rows: HTMLTableRowElement[] = [];
  private current = -1;

  constructor(
    journeys: Journey[],
    private readonly review: Review,
    private readonly select: (c: Case) => void,
  ) {
    this.cases = journeys.flatMap((journey) => journey.stretches.map((stretch) => ({ journey, stretch })));
    this.cases.sort((a, b) => b.stretch.probability - a.stretch.probability);
    this.show();
  }

  get selected(): Case | null {
    return this.cases[this.current] ?? null;
  }

  show(): void {
    this.rows = [];
    this.element.replaceChildren(element('h2', {}, `Ambiguous stretches (${this.cases.length}) · N / B to step`));
    if (this.cases.length === 0) {
      this.element.append(element('p', { class: 'empty' }, 'Every journey has one path that the recording and the map allow.'));
      return;
    }
    const table = element('table');
    table.append(element('caption', { class: 'visually-hidden' }, 'Stretches where another path is plausible, least certain first'));
    const head = table.createTHead().insertRow();
    for (const name of ['Other', 'Journey', 'Path 1 took', 'It may have been', 'Log-likelihood']) head.append(element('th', { scope: 'col' }, name));
    const body = table.createTBody();
    this.cases.forEach((c, index) => body.append(this.row(c, index)));
    const scroll = element('div', { class: 'scroll', tabindex: '0', 'aria-label': 'Ambiguous stretches' });
    scroll.append(table);
    this.element.append(scroll);
    this.rows[this.current]?.setAttribute('aria-current', 'true');
  }

  step(by: 1 | -1): void {
    if (this.cases.length > 0) this.goTo((this.current + by + this.cases.length) % this.cases.length);
  }

  private row({ journey, stretch }: Case, index: number): HTMLTableRowElement {
    const row = element('tr');
    const decided = this.review.decided(journey, stretch);
    row.append(element('th', { scope: 'row' }, `${decided ? '✓ ' : ''}${percent(stretch.probability)}`));
    const link = element('button', { type: 'button' }, `${shortName(journey.recording)} · ${journey.number}`);
    link.title = journey.recording;
    link.addEventListener('click', () => this.goTo(index));
    row.insertCell().append(link);
    row.insertCell().textContent = stretch.taken.join(' ');
    row.insertCell().textContent = stretch.alternative.join(' ') || 'another end';
    row.insertCell().textContent = deciding(stretch.evidence);
    if (decided) row.title = decided.comment ?? 'decided';
    this.rows.push(row);
    return row;
  }

  private goTo(index: number): void {
    this.rows[this.current]?.removeAttribute('aria-current');
    this.current = index;
    this.rows[index].setAttribute('aria-current', 'true');
    this.rows[index].scrollIntoView({ block: 'nearest' });
    this.select(this.cases[index]);
  }
}
