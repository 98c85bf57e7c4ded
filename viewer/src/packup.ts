// SPDX-License-Identifier: Apache-2.0
import type { PackUpItem } from './contract';
import { element } from './text';

/** "Can I pack up?": what must be right before the possession ends. */
export function packUpPanel(items: PackUpItem[], partial: boolean): HTMLElement {
  const panel = element('details', { class: 'packup' });
  panel.open = partial; // while the job runs this is what one waits for
  if (items.length === 0) {
    panel.hidden = true;
    return panel;
  }
  const bad = items.filter((item) => !item.good);
  const good = bad.length === 0;
  const summary = element('summary');
  summary.append(element('h2', { class: good ? 'good' : 'bad' }, `Can I pack up? ${good ? partial ? '✓ so far yes' : '✓ yes' : `✗ ${bad[0].name}${bad.length > 1 ? ` and ${bad.length - 1} more` : ''}`}`));
  const list = element('ul');
  for (const item of [...bad, ...items.filter((i) => i.good)]) {
    list.append(element('li', { class: item.good ? 'good' : 'bad' }, `${item.good ? '✓' : '✗'} ${item.name}: ${item.text}`));
  }
  panel.append(summary, list);
  return panel;
}
