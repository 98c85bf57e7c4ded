// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import { element } from './text';
import type { View } from './view';

/** A modal box that is gone when it is closed. */
export function openDialog(label: string, ...content: Node[]): HTMLDialogElement {
  const dialog = element('dialog', { 'aria-label': label });
  dialog.append(...content);
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

/** Asks for a kilometre or a time and goes there. */
export function askPlace(axis: Axis, view: View): void {
  const form = element('form', { method: 'dialog' });
  const input = element('input', { id: 'place', placeholder: axis.example, autocomplete: 'off' });
  const note = element('p', { role: 'alert' });
  form.append(element('label', { for: 'place' }, `Go to ${axis.unit}`), input, note);
  form.addEventListener('submit', (event) => {
    const places = axis.find(input.value);
    const inside = (places ?? []).filter((x) => x >= view.first - 0.5 && x <= view.last + 0.5);
    if (inside.length === 0) {
      event.preventDefault();
      note.textContent = places === null ? `Write it like ${axis.example}.` : 'This place is not in the result.';
      return;
    }
    // Where a kilometre is posted twice, the next one after the cursor.
    view.goTo(inside.find((x) => x > view.cursor + 0.5) ?? inside[0]);
  });
  openDialog(`Go to ${axis.unit}`, form);
  input.focus();
}
