// SPDX-License-Identifier: Apache-2.0
import type { Result, Survey } from './contract';
import { element } from './text';

/** "Can I pack up?": what must be right before the possession ends. */
export function packUpPanel(survey: Survey, result: Result): HTMLElement {
  const panel = element('section', { class: 'packup', 'aria-label': 'Can I pack up?' });
  if (survey.packUp.length === 0) {
    panel.hidden = true;
    return panel;
  }
  const good = !result.running && survey.packUp.every((item) => item.good);
  const verdict = result.running ? 'still running' : good ? 'yes' : 'not yet';
  panel.append(element('h2', { class: good ? 'good' : 'bad' }, `Can I pack up? ${verdict}`));
  const list = element('ul');
  for (const item of survey.packUp) {
    list.append(element('li', { class: item.good ? 'good' : 'bad' }, `${item.good ? '✓' : '✗'} ${item.name}: ${item.text}`));
  }
  panel.append(list);
  return panel;
}
