// SPDX-License-Identifier: Apache-2.0
import { openDialog } from './dialogs';
import { element } from './text';

type Handlers = Record<string, (shift: boolean) => unknown>;

/** Keys work wherever the focus is, but not while a person types or a dialog is open. */
export function bindKeys(signal: AbortSignal, handlers: Handlers): void {
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const handler = handlers[key] ?? (key === '=' ? handlers['+'] : undefined);
    if (!handler) return;
    event.preventDefault();
    handler(event.shiftKey);
  }, { signal });
}

const help: [string, string][] = [
  ['← →', 'move the cursor (Shift: ten times as far)'],
  ['+ −', 'zoom in and out'],
  ['PgUp PgDn', 'one screen back or on'],
  ['Home End', 'start and end of the line'],
  ['F', 'show the whole line'],
  ['N B', 'next and previous exceedance'],
  ['Y', 'scale to limits or to data'],
  ['G', 'go to a kilometre'],
  ['M', 'mark this place'],
  ['D', 'theme: dark, light, dim red'],
  ['E', 'export what is seen: PNG, CSV, PDF; faults and marks as GPX'],
  ['P', 'open the report'],
  ['1–9 Enter U', 'georeferencing: choose a path, confirm, undo'],
  ['T', 'georeferencing: time or distance'],
  ['Mouse', 'drag zooms, wheel zooms at the cursor, Shift+wheel pans, double click shows all'],
];

export function showHelp(): void {
  const list = element('dl');
  for (const [key, what] of help) list.append(element('dt', {}, key), element('dd', {}, what));
  const form = element('form', { method: 'dialog' });
  form.append(element('button', { type: 'submit' }, 'Close'));
  openDialog('Keys', element('h2', {}, 'Keys'), list, form);
}
