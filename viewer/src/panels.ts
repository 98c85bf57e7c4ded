// SPDX-License-Identifier: Apache-2.0
import type { Axis } from './axis';
import type { Result } from './contract';
import { element, minus } from './text';

/** A tab that holds tables instead of strips. */
interface Panel {
  id: string;
  title: string;
  has(result: Result): boolean;
  make(result: Result, axis: Axis, go: (x: number) => void): HTMLElement;
}

type Cell = string | Node;

export function table(caption: string, head: string[], rows: Cell[][]): HTMLElement {
  const section = element('section', { class: 'sheet' });
  const node = element('table');
  node.append(element('caption', {}, caption));
  const titles = node.createTHead().insertRow();
  for (const name of head) titles.append(element('th', { scope: 'col' }, name));
  const body = node.createTBody();
  for (const row of rows) {
    const line = body.insertRow();
    for (const cell of row) line.insertCell().append(cell);
  }
  section.append(node);
  return section;
}

function controlPoints(result: Result, axis: Axis, go: (x: number) => void): HTMLElement {
  const survey = result.survey!;
  const rows = survey.controlPoints.map((c): Cell[] => {
    const place = element('button', { type: 'button', class: 'link' }, axis.text(c.x, 1));
    place.addEventListener('click', () => go(c.x));
    const parts = c.innovation.map((v, i) => (v === null ? '–' : `${minus(v, 1)} ± ${c.sigma[i] === null ? '–' : (1.96 * c.sigma[i]!).toFixed(1)}`));
    const ratio = c.nis === null ? '–' : minus(c.nis, 2);
    return [c.name, place, ...parts, ratio, c.used ? 'used' : '■ rejected'];
  });
  const note = 'Difference between the control point and where the run expected it before using it, with its 95 % interval; north, east, down.';
  return table(note, ['No', axis.unit, 'North mm', 'East mm', 'Down mm', 'NIS of 3', ''], rows);
}

function notes(result: Result): HTMLElement {
  const out = element('div', { class: 'sheets' });
  const { warnings, findings, rejections, rejected } = result;
  out.append(table('Warnings', ['What'], warnings.length > 0 ? warnings.map((w) => [w]) : [['none']]));
  if (findings.length > 0) {
    out.append(table('What the checks found in the recording', ['Sensor', 'Kind', 'From', 'Samples', 'Done', 'Detail'], findings.map((f) => [f.sensor, f.kind, f.from, String(f.count), f.action, f.detail])));
  }
  if (rejections.length > 0) {
    const caption = `Measurements that were not used: ${rejected}${rejected > rejections.length ? `, the first ${rejections.length} here, all in rejections.csv` : ''}`;
    out.append(table(caption, ['Sensor', 'Time s', 'Reason', 'Normalised'], rejections.map((r) => [r.sensor, r.time_s, r.reason, r.normalized === null ? '–' : minus(r.normalized, 1)])));
  }
  const conventions = Object.entries(result.survey?.conventions ?? {});
  if (conventions.length > 0) out.append(table('Conventions', ['What', 'How'], conventions));
  const { profile, source } = result.verdict;
  if (profile) out.append(table('Limits', ['Profile', 'Source'], [[profile, source ?? '']]));
  return out;
}

export const panels: Panel[] = [
  { id: 'control', title: 'Control points', has: (r) => (r.survey?.controlPoints.length ?? 0) > 0, make: controlPoints },
  { id: 'notes', title: 'Notes', has: () => true, make: notes },
];
