// SPDX-License-Identifier: Apache-2.0
import type { Result } from './contract';
import { element } from './text';

export interface HeaderActions {
  theme(): void;
  help(): void;
  exports(): void;
  report(): void;
}

/** Job, verdict, place of the cursor, and what every screen offers. */
export function header(result: Result, readout: HTMLElement, actions: HeaderActions): HTMLElement {
  const bar = element('header');
  const compared = result.survey?.compare;
  const beside = result.georef?.compare;
  const { accepted, text, profile, source } = result.verdict;
  const state = accepted === null ? '' : accepted ? 'good' : 'bad';
  const glyph = accepted === null ? '' : accepted ? '✓ ' : '■ ';
  const verdict = element('strong', { class: `verdict ${state}`, title: [profile, source].filter(Boolean).join(': ') }, `${glyph}${text}`);
  const button = (label: string, key: string, action: () => void) => {
    const b = element('button', { type: 'button', 'aria-keyshortcuts': key }, `${label} `);
    b.append(element('kbd', { 'aria-hidden': 'true' }, key));
    b.addEventListener('click', action);
    return b;
  };
  bar.append(
    element('h1', { title: `${result.folder}, Versine ${result.version}` }, result.title),
    verdict,
    element('span', { class: 'subtitle' }, compared ? `minus ${compared} · ${result.subtitle}` : beside ? `against ${beside} · ${result.subtitle}` : result.subtitle),
    element('span', { class: 'progress', role: 'status' }),
    readout,
    button('Theme', 'D', actions.theme),
    button('Export', 'E', actions.exports),
    button('Keys', '?', actions.help),
  );
  if (result.report) bar.append(button('Report', 'P', actions.report));
  return bar;
}
