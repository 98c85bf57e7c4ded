// SPDX-License-Identifier: Apache-2.0
import type { LimitClass } from './contract';

export type Theme = 'dark' | 'light' | 'red';
const order: Theme[] = ['dark', 'light', 'red'];

export function currentTheme(): Theme {
  return (document.documentElement.dataset.theme as Theme) ?? 'dark';
}

export function initTheme(): void {
  const stored = localStorage.getItem('versine-theme') as Theme | null;
  const preferred: Theme = matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark';
  document.documentElement.dataset.theme = stored && order.includes(stored) ? stored : preferred;
}

/** Dark, light, and dim red for eyes that must stay used to the night. */
export function nextTheme(): Theme {
  const next = order[(order.indexOf(currentTheme()) + 1) % order.length];
  document.documentElement.dataset.theme = next;
  localStorage.setItem('versine-theme', next);
  return next;
}

/** Another theme for a while, as for paper; call the answer to go back. */
export function withTheme(theme: Theme): () => void {
  const before = currentTheme();
  document.documentElement.dataset.theme = theme;
  return () => {
    document.documentElement.dataset.theme = before;
  };
}

const colours = new Map<string, string>();

/** A colour of the present theme; looked up once a theme, since every frame asks for dozens. */
export function css(name: string): string {
  const key = currentTheme() + name;
  let value = colours.get(key);
  if (value === undefined) {
    value = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    colours.set(key, value);
  }
  return value;
}

/** Never colour alone: each class has its own line and its own sign. */
export const limitStyle: Record<LimitClass, { color: string; dash: number[]; glyph: string; name: string }> = {
  AL: { color: '--al', dash: [1, 3], glyph: '▲', name: 'alert limit' },
  IL: { color: '--il', dash: [6, 4], glyph: '◆', name: 'intervention limit' },
  IAL: { color: '--ial', dash: [], glyph: '■', name: 'immediate action limit' },
};
