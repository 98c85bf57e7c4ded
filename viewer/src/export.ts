// SPDX-License-Identifier: Apache-2.0
import type { Chainage } from './chainage';
import type { Strip } from './strips';
import { css } from './theme';
import type { View } from './view';

function save(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const fileName = (title: string, ending: string) => `${title.replace(/[^\p{L}\p{N}]+/gu, '-')}.${ending}`;

/** The strips as they are seen, one below the other, with their titles. */
export function exportPng(strips: Strip[], title: string): void {
  const canvases = strips.map((s) => s.canvas).filter((c): c is HTMLCanvasElement => c !== null);
  if (canvases.length === 0) return;
  const label = 200 * devicePixelRatio;
  const out = document.createElement('canvas');
  out.width = label + Math.max(...canvases.map((c) => c.width));
  out.height = canvases.reduce((sum, c) => sum + c.height, 0);
  const ctx = out.getContext('2d')!;
  ctx.fillStyle = css('--background');
  ctx.fillRect(0, 0, out.width, out.height);
  ctx.fillStyle = css('--text');
  ctx.font = `${13 * devicePixelRatio}px system-ui, sans-serif`;
  let y = 0;
  strips.forEach((strip, i) => {
    ctx.fillText(`${strip.info.title} [${strip.info.unit}]`, 8, y + 20 * devicePixelRatio);
    ctx.drawImage(canvases[i], label, y);
    y += canvases[i].height;
  });
  out.toBlob((blob) => blob && save(fileName(title, 'png'), blob));
}

/** Every sample of the visible stretch, as in the result's own CSV. */
export function exportCsv(strips: Strip[], view: View, chainage: Chainage, title: string): void {
  const whole = strips.filter((s) => s.store.whole);
  if (whole.length === 0) return;
  const columns = whole.map((s) => s.store.samples(view.from, view.to));
  const head = ['distance_m', 'posted_m', ...whole.flatMap((s) => [`${s.info.id}_${s.info.unit.replace('/', '_per_')}`, `${s.info.id}_half95`])];
  const number = (v: number) => (Number.isFinite(v) ? String(Math.round(v * 1e6) / 1e6) : '');
  const rows = Array.from(columns[0].x, (x, i) => [
    x.toFixed(3),
    chainage.posted(x).toFixed(3),
    ...columns.flatMap((c) => [number(c.min[i]), c.lower && c.upper ? number((c.upper[i] - c.lower[i]) / 2) : '']),
  ]);
  save(fileName(title, 'csv'), new Blob([[head, ...rows].map((r) => r.join(',')).join('\n') + '\n'], { type: 'text/csv' }));
}
