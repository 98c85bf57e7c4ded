// SPDX-License-Identifier: Apache-2.0
import type { Difference, Georef, Journey } from './contract';
import { element, shortName } from './text';

/** Where the journeys of two runs are on different tracks: a list, each place a button. */
export function differenceList(georef: Georef, go: (journey: Journey, difference: Difference) => void): HTMLElement {
  const out = element('section', { class: 'differences', 'aria-label': 'Differences of two runs' });
  if (georef.compare === undefined) {
    out.hidden = true;
    return out;
  }
  const list = element('ul');
  let count = 0;
  for (const journey of georef.journeys) {
    if (!journey.other) list.append(element('li', {}, `${shortName(journey.recording)} · ${journey.number}: not in the other run`));
    for (const d of journey.differs ?? []) {
      ++count;
      const names = (tracks: string[]) => tracks.join(' ') || 'nothing';
      const text = `${shortName(journey.recording)} · ${journey.number}, ${d.fromM.toFixed(0)} to ${d.toM.toFixed(0)} m: ${names(d.here)} here, ${names(d.there)} there`;
      const button = element('button', { type: 'button', class: 'link' }, text);
      button.addEventListener('click', () => go(journey, d));
      const line = element('li');
      line.append(button);
      list.append(line);
    }
  }
  const heading = count === 0 ? `Same tracks as ${georef.compare}` : `Differs from ${georef.compare} (${count})`;
  out.append(element('h2', {}, heading), list);
  return out;
}
