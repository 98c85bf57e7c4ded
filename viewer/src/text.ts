// SPDX-License-Identifier: Apache-2.0

/** A number as people write it: a real minus sign, never "-0.0". */
export function minus(value: number, digits?: number): string {
  if (!Number.isFinite(value)) return '–';
  let text = digits === undefined ? String(Math.round(value * 1e6) / 1e6) : value.toFixed(digits);
  if (/^-0(\.0*)?$/.test(text)) text = text.slice(1);
  return text.replace('-', '−');
}

export function percent(probability: number | null): string {
  if (probability === null || !Number.isFinite(probability)) return '–';
  const p = Math.round(100 * probability);
  if (p === 100 && probability < 1) return '>99%';
  if (p === 0 && probability > 0) return '<1%';
  return `${p}%`;
}

let speaking = 0;

/** Speaks to a screen reader once things have come to rest; the same text twice is spoken once. */
export function speak(text: string): void {
  clearTimeout(speaking);
  speaking = window.setTimeout(() => {
    const live = document.getElementById('live');
    if (live && live.textContent !== text) live.textContent = text;
  }, 200);
}

export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {}, text = ''): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text) node.textContent = text;
  return node;
}

/** A recording's name without the folders it lies in. */
export const shortName = (recording: string) => recording.slice(recording.lastIndexOf('/') + 1);
