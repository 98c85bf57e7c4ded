// SPDX-License-Identifier: Apache-2.0
import type { Constraint, Journey } from './contract';
import { chooseStretch, choosePath, forbid, type Review } from './review';
import type { Case } from './stretches';
import { element, percent, speak } from './text';

export interface ChoiceEvents {
  preview(path: number): void;
  decided(): void;
}

/** What a person decides: of the selected stretch, or, where none is selected, of the whole journey. */
export class Choice {
  readonly element = element('section', { class: 'choice', 'aria-label': 'Review' });
  private journey: Journey | null = null;
  private stretch: Case['stretch'] | null = null;
  private path = 1;
  private note = '';

  constructor(
    private readonly review: Review,
    private readonly file: string,
    private readonly events: ChoiceEvents,
  ) {}

  about(journey: Journey, stretch: Case['stretch'] | null): void {
    [this.journey, this.stretch, this.path, this.note] = [journey, stretch, 1, ''];
    this.show();
  }

  /** Paths that differ here. */
  private options(): { path: number; label: string; probability: number }[] {
    const { journey, stretch } = this;
    if (!journey) return [];
    if (!stretch) return journey.hypotheses.map((h) => ({ path: h.path, label: h.tracks.map((t) => t.id).join(' '), probability: h.probability }));
    const other = stretch.paths[0] ?? 2;
    return [
      { path: 1, label: stretch.taken.join(' '), probability: 1 - stretch.probability },
      { path: other, label: stretch.alternative.join(' ') || 'another end', probability: stretch.probability },
    ];
  }

  choose(path: number): void {
    if (!this.options().some((o) => o.path === path)) return;
    this.path = path;
    this.events.preview(path);
    this.show();
    speak(`path ${path}`);
  }

  async confirm(): Promise<void> {
    if (this.journey) await this.decide(this.constraint(this.journey));
  }

  async exclude(): Promise<void> {
    if (!this.journey || !this.stretch) return;
    await this.decide(forbid(this.journey, this.stretch, this.comment() || 'not there'));
  }

  async undo(): Promise<void> {
    await this.act(async () => speak((await this.review.undo()) ? 'taken back' : 'nothing to take back'));
  }

  private constraint(journey: Journey): Constraint {
    const text = this.comment() || `path ${this.path} confirmed`;
    if (!this.stretch) return choosePath(journey, this.path, text);
    return chooseStretch(journey, this.stretch, this.path === 1 ? this.stretch.taken : this.stretch.alternative, text);
  }

  private comment(): string {
    return this.element.querySelector('input')?.value.trim() ?? '';
  }

  private async decide(constraint: Constraint): Promise<void> {
    await this.act(async () => {
      await this.review.confirm(constraint);
      speak('confirmed');
    });
  }

  private async act(what: () => Promise<void>): Promise<void> {
    try {
      await what();
      this.note = '';
    } catch (error) {
      this.note = error instanceof Error ? error.message : String(error);
    }
    this.events.decided();
    this.show();
  }

  private show(): void {
    const { journey, stretch } = this;
    const text = this.comment();
    this.element.replaceChildren(element('h2', {}, stretch ? 'This stretch · 1–9 choose, Enter confirms, U undoes' : 'This journey · 1–9 choose, Enter confirms, U undoes'));
    if (!journey) return;
    const list = element('div', { class: 'choices', role: 'radiogroup', 'aria-label': 'Paths' });
    for (const o of this.options().slice(0, 9)) {
      const button = element('button', { type: 'button', role: 'radio', 'aria-checked': String(o.path === this.path), 'data-path': String(o.path) }, `${o.path}  ${percent(o.probability)}  ${o.label}`);
      button.addEventListener('click', () => this.choose(o.path));
      list.append(button);
    }
    const comment = element('input', { placeholder: 'why, for people', 'aria-label': 'Comment', value: text });
    const bar = element('div', { class: 'bar' });
    const confirm = element('button', { type: 'button', 'data-action': 'confirm' }, 'Confirm');
    confirm.addEventListener('click', () => void this.confirm());
    const none = element('button', { type: 'button', 'data-action': 'exclude', title: 'the tracks that path 1 alone has here are forbidden' }, 'Not on path 1');
    none.addEventListener('click', () => void this.exclude());
    bar.append(confirm, ...(stretch ? [none] : []));
    this.element.append(list, comment, bar);
    if (this.note) this.element.append(element('p', { class: 'bad', role: 'alert' }, this.note));
    this.element.append(this.decisions());
  }

  /** Everything decided so far, and what to do with it. */
  private decisions(): HTMLElement {
    const out = element('div', { class: 'decisions' });
    const list = element('ul');
    this.review.constraints.forEach((c, i) => {
      const line = element('li', {}, `${c.recording ?? 'every recording'}: ${c.excluded ? 'not ' : ''}${c.tracks.join(' ')} · ${c.comment ?? ''} `);
      const remove = element('button', { type: 'button', 'aria-label': `remove decision ${i + 1}` }, '×');
      remove.addEventListener('click', () => void this.act(() => this.review.remove(i)));
      line.append(remove);
      list.append(line);
    });
    if (this.review.constraints.length > 0) {
      out.append(element('h2', {}, `Decided (${this.review.constraints.length})`), list, element('p', { class: 'empty' }, `Kept in ${this.file} beside the result; the next run obeys it with constraints = "${this.file}" in the job.`));
    }
    return out;
  }
}
