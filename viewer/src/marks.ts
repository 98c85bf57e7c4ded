// SPDX-License-Identifier: Apache-2.0
import { getMarks, putMarks } from './api';
import type { Axis } from './axis';
import { element } from './text';

export interface Mark {
  x: number;
  place: string; // as posted
  time: string;
}

/** Places that the user marked: kept in a file beside the result, so that they survive page and program. Where that
 * cannot be written the browser keeps them until it is closed, and the heading says so. */
export class Marks {
  readonly element = element('section', { class: 'marks', 'aria-label': 'Marks' });
  private readonly key: string;
  private list: Mark[] = [];
  private kept = true;

  constructor(
    title: string,
    private readonly axis: Axis,
    private readonly go: (x: number) => void,
  ) {
    this.key = `versine-marks:${title}`;
    this.show();
  }

  async load(): Promise<void> {
    const stored = (await getMarks()) as Mark[];
    const here = JSON.parse(sessionStorage.getItem(this.key) ?? '[]') as Mark[];
    this.list = stored.length > 0 ? stored : here;
    this.show();
  }

  places(): Mark[] {
    return this.list;
  }

  add(x: number): void {
    this.list.push({ x, place: this.axis.text(x, 1), time: new Date().toISOString() });
    void this.save();
  }

  private async save(): Promise<void> {
    sessionStorage.setItem(this.key, JSON.stringify(this.list));
    this.show();
    try {
      await putMarks(this.list);
      this.kept = true;
    } catch {
      this.kept = false;
      this.show();
    }
  }

  private show(): void {
    this.element.hidden = this.list.length === 0;
    const items = this.list.map((mark, i) => {
      const item = element('li');
      const place = element('button', { type: 'button', class: 'link' }, `⚑ ${mark.place}`);
      place.addEventListener('click', () => this.go(mark.x));
      const remove = element('button', { type: 'button', 'aria-label': `Remove mark ${mark.place}` }, '×');
      remove.addEventListener('click', () => {
        this.list.splice(i, 1);
        void this.save();
      });
      item.append(place, remove);
      return item;
    });
    const list = element('ul');
    list.append(...items);
    this.element.replaceChildren(element('h2', {}, `Marks (${this.list.length})${this.kept ? '' : ' · only in this browser'}`), list);
  }
}
