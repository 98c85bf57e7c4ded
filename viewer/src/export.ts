// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import type { Polyline, Result } from './contract';
import { openDialog } from './dialogs';
import type { Mark } from './marks';
import { lowerBound } from './pyramid';
import type { Strip } from './strips';
import { element } from './text';
import { css, withTheme } from './theme';
import type { View } from './view';

export interface Exported {
  strips: Strip[];
  view: View;
  axis: Axis;
  result: Result;
  marks: Mark[];
  map?: HTMLCanvasElement | null; // above the strips in the picture
  redraw(): void; // after a change of theme
}

function save(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const fileName = (title: string, ending: string) => `${title.replace(/[^\p{L}\p{N}]+/gu, '-')}.${ending}`;

/** The strips as they are seen, one below the other, with their titles. */
function exportPng({ strips, result, axis, view, map }: Exported): void {
  const canvases = strips.map((s) => s.canvas).filter((c): c is HTMLCanvasElement => c !== null);
  if (canvases.length === 0) return;
  const label = 200 * devicePixelRatio;
  const head = 30 * devicePixelRatio;
  const out = document.createElement('canvas');
  out.width = label + Math.max(...canvases.map((c) => c.width));
  const above = map ? Math.round((map.height * out.width) / map.width) : 0;
  out.height = head + above + canvases.reduce((sum, c) => sum + c.height, 0);
  const ctx = out.getContext('2d')!;
  ctx.fillStyle = css('--background');
  ctx.fillRect(0, 0, out.width, out.height);
  const write = (text: string, x: number, y: number, weight: string, color: string) => {
    ctx.font = `${weight} ${13 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.fillStyle = css(color);
    ctx.fillText(text, x, y);
  };
  write(`${result.title} · ${axis.readout(view.from)} to ${axis.readout(view.to)}`, 8, 20 * devicePixelRatio, 'bold', '--text');
  if (map) ctx.drawImage(map, 0, head, out.width, above);
  let y = head + above;
  strips.forEach((strip, i) => {
    write(strip.info.title, 8, y + 18 * devicePixelRatio, 'bold', '--text');
    write([strip.info.note, strip.info.unit].filter(Boolean).join(' · '), 8, y + 34 * devicePixelRatio, 'normal', '--muted');
    ctx.drawImage(canvases[i], label, y);
    y += canvases[i].height;
  });
  out.toBlob((blob) => blob && save(fileName(result.title, 'png'), blob));
}

const number = (v: number) => (Number.isFinite(v) ? String(Math.round(v * 1e5) / 1e5) : '');

/** Every sample of the visible stretch under the names of the result's own CSV. Strips need not be sampled at the same
 * places: a field is empty where its strip has no sample. */
export async function csvOf({ strips, view, axis }: Exported): Promise<string> {
  const columns = await Promise.all(strips.map(async (s) => ({ id: s.info.id, series: await s.store.samples(view.from, view.to) })));
  const grid = [...new Set(columns.flatMap((c) => [...c.series.x]))].sort((a, b) => a - b);
  const fields = columns.map(({ series }) => {
    const { x, min, sigma } = series;
    let next = 0;
    return (place: number): string[] => {
      while (next < x.length && x[next] < place) ++next;
      const here = x[next] === place;
      const value = here ? number(min[next]) : '';
      return sigma ? [value, here ? number(sigma[next]) : ''] : [value];
    };
  });
  const head = [axis.unit === 'km' ? 'distance_m' : 'time_s', 'place', ...columns.flatMap((c) => (c.series.sigma ? [c.id, `sigma_${c.id}`] : [c.id]))];
  const rows = grid.map((x) => [x.toFixed(3), axis.text(x, 3), ...fields.flatMap((f) => f(x))]);
  return [head, ...rows].map((row) => row.join(',')).join('\n') + '\n';
}

/** Latitude and longitude at a place, between two vertices of the plan. */
function position(plan: Polyline[], x: number): [number, number] | null {
  for (const { x: at, latitude, longitude } of plan) {
    if (!latitude || !longitude || x < at[0] || x > at[at.length - 1]) continue;
    const i = Math.max(1, lowerBound(at, x));
    const f = (x - at[i - 1]) / (at[i] - at[i - 1]);
    return [latitude[i - 1] + f * (latitude[i] - latitude[i - 1]), longitude[i - 1] + f * (longitude[i] - longitude[i - 1])];
  }
  return null;
}

const escaped = (text: string) => text.replace(/[<>&"]/g, (c) => `&#${c.charCodeAt(0)};`);

/** Exceedances and marks as waypoints for a hand-held receiver. */
export function gpxOf({ result, axis, marks }: Exported): string {
  const { exceedances, plan } = result.survey!;
  const point = (x: number, name: string, text: string) => {
    const at = position(plan, x);
    return at ? `  <wpt lat="${at[0].toFixed(8)}" lon="${at[1].toFixed(8)}"><name>${escaped(name)}</name><desc>${escaped(text)}</desc></wpt>\n` : '';
  };
  const points = [
    ...exceedances.map((e) => point(e.peakAt, `${e.level} ${e.title} ${axis.text(e.peakAt)}`, `${e.peak.toFixed(e.digits)} ${e.unit}, limit ${e.limit} ${e.unit}`)),
    ...marks.map((m) => point(m.x, `Mark ${m.place}`, m.time)),
  ];
  return `<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="Versine" xmlns="http://www.topografix.com/GPX/1/1">\n${points.join('')}</gpx>\n`;
}

/** On paper everything is light, and as wide as a page; screen and theme come back when the print dialog is closed. */
function print(what: Exported): void {
  const restore = withTheme('light');
  const page = document.documentElement.classList;
  page.add('printing');
  what.redraw();
  addEventListener(
    'afterprint',
    () => {
      page.remove('printing');
      restore();
      what.redraw();
    },
    { once: true },
  );
  setTimeout(() => window.print(), 300); // after the redrawing
}

export function showExports(what: Exported): void {
  const { result, axis, view } = what;
  const choices: [string, () => void][] = [
    ['PNG: the strips as they are seen', () => exportPng(what)],
    ['CSV: every sample of what is seen', () => void csvOf(what).then((text) => save(fileName(result.title, 'csv'), new Blob([text], { type: 'text/csv' })))],
    ['PDF: this page, through the print dialog', () => print(what)],
  ];
  if (result.survey) choices.push(['GPX: exceedances and marks', () => save(fileName(result.title, 'gpx'), new Blob([gpxOf(what)], { type: 'application/gpx+xml' }))]);
  const list = element('div', { class: 'choices' });
  for (const [label, action] of choices) {
    const button = element('button', { type: 'button' }, label);
    button.disabled = what.strips.length === 0 && !label.startsWith('GPX') && !label.startsWith('PDF');
    button.addEventListener('click', () => {
      dialog.close();
      action();
    });
    list.append(button);
  }
  const close = element('button', { type: 'button' }, 'Close');
  close.addEventListener('click', () => dialog.close());
  const dialog = openDialog('Export', element('h2', {}, `Export ${axis.readout(view.from)} to ${axis.readout(view.to)}`), list, close);
}
