// SPDX-License-Identifier: Apache-2.0
import type { Chainage } from './chainage';
import { element } from './text';

interface Mark {
  x: number;
  time: string;
}

/** Places that the user marked; kept by the browser, so they survive a crash of page or program. */
export class Marks {
  readonly element = element('section', { class: 'marks', 'aria-label': 'Marks' });
  private readonly key: string;
  private list: Mark[];

  constructor(
    title: string,
    private readonly chainage: Chainage,
  ) {
    this.key = `versine-marks:${title}`;
    this.list = JSON.parse(localStorage.getItem(this.key) ?? '[]') as Mark[];
    this.show();
  }

  add(x: number): void {
    this.list.push({ x, time: new Date().toISOString() });
    this.save();
  }

  private save(): void {
    localStorage.setItem(this.key, JSON.stringify(this.list));
    this.show();
  }

  private show(): void {
    this.element.hidden = this.list.length === 0;
    const items = this.list.map((mark, i) => {
      const item = element('li', {}, `km ${this.chainage.text(mark.x, 1)} `);
      const remove = element('button', { type: 'button', 'aria-label': `Remove mark ${i + 1}` }, '×');
      remove.addEventListener('click', () => {
        this.list.splice(i, 1);
        this.save();
      });
      item.append(remove);
      return item;
    });
    const list = element('ul');
    list.append(...items);
    this.element.replaceChildren(element('h2', {}, `Marks (${this.list.length})`), list);
  }
}
