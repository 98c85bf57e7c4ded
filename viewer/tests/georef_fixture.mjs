// SPDX-License-Identifier: Apache-2.0
// A georeferencing's result folder, written from docs/formats-georef.md alone.
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';

/** A journey of 20 s over tracks A and B, which may have gone over C instead of B; in a network of `lines` lines, or with
 * the lines `more`, of longitude and latitude; `swapped` when it rather went over C. */
export function writeGeorefResult(folder, { lines = 3, more = [], swapped = false, title = 'A made journey' } = {}) {
  mkdirSync(folder, { recursive: true });
  const write = (file, text) => writeFileSync(path.join(folder, file), text);
  const line = [[9, 52, 0], [9, 52.0009, 100], [9, 52.0018, 200]];
  const other = [[9, 52, 0], [9, 52.0009, 100], [9.0002, 52.0018, 200]];
  const track = (id, from_m, to_m) => ({ id, line: id, reversed: false, from_m, to_m });
  const hypothesis = (n, probability, second, places) => ({ path: n, probability, log_likelihood: -n, log_prior: 0, from_m: 5, to_m: 195, line: places, evidence: {}, tracks: [track('A', 0, 100), track(second, 100, 200)] });
  write('georef.json', JSON.stringify({
    format: 'versine-georef 1',
    network: { file: 'map.gpkg', geojson: 'network.geojson', crs: 'EPSG:25832', tracks: lines, warnings: [] },
    recordings: [{ name: 'run.h5', journeys: [{ journey: 1, from_s: 1000, to_s: 1019, length_m: 190, fixes: 20, rejected: 1, entropy_nat: 0.5, paths: swapped ? [hypothesis(1, 0.7, 'C', other), hypothesis(2, 0.3, 'B', line)] : [hypothesis(1, 0.8, 'B', line), hypothesis(2, 0.2, 'C', other)],
      ambiguous: [{ from_s: 1010, to_s: 1019, from_m: 100, to_m: 195, taken: ['B'], alternative: ['C'], paths: [2], probability: 0.2, evidence: { position: 1.4, route: -0.2 } }] }] },
    { name: 'broken.h5', error: 'no fix lies on the map' }],
  }));
  const feature = (id, coordinates) => ({ type: 'Feature', properties: { id }, geometry: { type: 'LineString', coordinates } });
  const features = [feature('A', [[9, 52], [9, 52.0009]]), feature('B', [[9, 52.0009], [9, 52.0018]]), feature('C', [[9, 52.0009], [9.0002, 52.0018]])];
  for (let i = 3; i < lines; ++i) {
    const [east, north] = [7 + 4 * ((i * 0.618) % 1), 50 + 3 * ((i * 0.382) % 1)];
    features.push(feature(`T${i}`, Array.from({ length: 17 }, (_, k) => [east + 0.001 * k, north + 0.0003 * Math.sin(k)])));
  }
  more.forEach((places, i) => features.push(feature(`T${i}`, places)));
  write('network.geojson', JSON.stringify({ type: 'FeatureCollection', features }));
  const times = Array.from({ length: 20 }, (_, k) => k);
  write('positions.csv', ['recording,journey,time_s,track,path_distance_m,speed_mps,sigma_m,sigma_speed_mps', ...times.map((t) => `1,1,${1000 + t},${t < 10 ? 'A' : 'B'},${5 + 10 * t},${10 + 0.125 * t},${0.5 + 0.01 * t},0.25`)].join('\n') + '\n');
  write('fixes.csv', ['recording,journey,time_s,latitude_deg,longitude_deg,sigma_m,status,along_m,across_m,sigma_along_m,sigma_across_m,nis,path_distance_m', ...times.map((t) => `1,1,${1000 + t},${52 + 0.00009 * t},9,1.5,${t === 7 ? 'rejected' : 'used'},0.25,-0.5,1,2,${t === 7 ? 99 : 0.5},${5 + 10 * t}`)].join('\n') + '\n');
  write('run.json', JSON.stringify({ format: 'versine run 1', command: 'georef', version: 'test', settings: { title } }));
  return folder;
}

