// SPDX-License-Identifier: Apache-2.0
// Result folders written from docs/formats.md and docs/track-geometry.md alone, small and exact.
import { mkdirSync, writeFileSync, openSync, writeSync, closeSync } from 'node:fs';
import path from 'node:path';

export const columns = [
  'curvature_per_km', 'gauge_deviation_mm', 'cross_level_mm', 'cross_level_deviation_mm', 'twist_3m_mm_per_m', 'level_left_d1_mm', 'level_right_d1_mm',
  'alignment_left_d1_mm', 'alignment_right_d1_mm', 'deviation_lateral_axis_mm', 'deviation_vertical_axis_mm', 'gradient_permille', 'height_axis_m',
];

/** A smooth signal with some noise, the same at every run. */
export function value(column, i) {
  const k = columns.indexOf(column) + 1;
  const noise = Math.sin(12.9898 * i + 78.233 * k) * 43758.5453;
  return (2 * Math.sin(i / (30 + 11 * k)) + 0.6 * (noise - Math.floor(noise)) + (column === 'height_axis_m' ? 280 : 0)).toFixed(3);
}
export const sigma = (i) => (0.2 + 0.1 * Math.sin(i / 500)).toFixed(3);

/**
 * count points every 0.25 m from continuous distance 0; posted from km 12, jumping back by 15 m at `jump`; no value in
 * [gap[0], gap[1]) (indices); exceedances as [column, level, peak index, value].
 */
export function writeResult(folder, { count = 8001, jump = null, gap = [0, 0], exceedances = [], title = 'Fixture', run = {}, offset = 0, only = columns } = {}) {
  mkdirSync(folder, { recursive: true });
  const step = 0.25;
  const posted = (x) => (jump !== null && x >= jump ? x + 12000 - 15 : x + 12000);
  const file = openSync(path.join(folder, 'geometry.csv'), 'w');
  let text = ['distance_m', 'mileage_m', 'time_s', 'flags', 'easting_axis_m', 'northing_axis_m', ...only.flatMap((c) => [c, `sigma_${c}`])].join(',') + '\n';
  for (let i = 0; i < count; ++i) {
    const x = i * step;
    const none = i >= gap[0] && i < gap[1];
    const row = [x.toFixed(3), posted(x).toFixed(3), (1400000000 + x).toFixed(4), none ? 2 : 0, none ? '' : (500000 + x * 0.8).toFixed(4), none ? '' : (5600000 + x * 0.6).toFixed(4)];
    const here = new Map(exceedances.filter((e) => e[2] === i).map((e) => [e[0], e[3]]));
    for (const c of only) row.push(none ? '' : (here.get(c) ?? (Number(value(c, i)) + offset).toFixed(3)), none ? '' : sigma(i));
    text += row.join(',') + '\n';
    if (text.length > 1 << 22) {
      writeSync(file, text);
      text = '';
    }
  }
  writeSync(file, text);
  closeSync(file);
  const limits = ['AL', 'IL', 'IAL'].map((level, k) => ({ column: 'level_left_d1_mm', unit: 'mm', level, low: -6 - 4 * k, high: 6 + 4 * k }));
  limits.push({ column: 'twist_3m_mm_per_m', unit: 'mm/m', level: 'IAL', low: -7, high: 7 });
  const counts = {};
  for (const [, level] of exceedances) counts[level] = (counts[level] ?? 0) + 1;
  const head = 'start_m,end_m,peak_m,length_m,column,unit,level,value,sigma,limit,probability_over,easting_m,northing_m,start_distance_m,end_distance_m,peak_distance_m';
  const lines = exceedances.map(([column, level, i, v, p = 0.99]) => {
    const [x, unit] = [i * step, column.endsWith('_mm_per_m') ? 'mm/m' : 'mm'];
    const name = column.replace(/_mm(_per_m)?$/, '');
    return [posted(x), posted(x), posted(x), 0, name, unit, level, v, 0.2, Math.sign(v) * 6, p, 500000 + x * 0.8, 5600000 + x * 0.6, x, x, x].join(',');
  });
  writeFileSync(path.join(folder, 'exceedances.csv'), [head, ...lines].join('\n') + '\n');
  const pieces = [{ start_m: 0, posted_m: 12000, increasing: true }];
  if (jump !== null) pieces.push({ start_m: jump, posted_m: 12000 + jump - 15, increasing: true });
  writeFileSync(path.join(folder, 'run.json'), JSON.stringify({
    format: 'versine run 1', command: 'geometry', version: '0.1.0', started_utc: '2026-01-01T00:00:00Z', time_scale: 'GPS, s since 1980-01-06', inputs: [],
    settings: { title, geometry: { design: 'design.xml', band: [{ name: 'd1', shortest_m: 3, longest_m: 25 }] } },
    results: { points: count, step_m: step, crs: 'EPSG:32632', posted: pieces, conventions: { lateral: 'positive right' }, quality: { limits: 'Fixture limits', source: 'the test', speed_kmh: 160, levels: ['AL', 'IL', 'IAL'], limits_applied: limits, exceedances: counts } },
    warnings: ['a warning'], findings: [], rejections: [], ...run,
  }));
  return folder;
}
