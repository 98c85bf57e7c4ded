// SPDX-License-Identifier: Apache-2.0
import type { Constraint, Points, Progress, Result, Series, Values } from './contract';

// The token comes in the URL's fragment, which no server log and no referrer ever sees; it is kept for reloads of this
// tab and taken out of the address bar.
function readToken(): string {
  const match = /[#&]token=([0-9a-f]+)/.exec(location.hash);
  if (match) {
    sessionStorage.setItem('versine-token', match[1]);
    const rest = location.hash.slice(1).split('&').filter((part) => part && !part.startsWith('token='));
    history.replaceState(null, '', location.pathname + (rest.length > 0 ? `#${rest.join('&')}` : ''));
  }
  return sessionStorage.getItem('versine-token') ?? '';
}
const token = readToken();

export class ServerError extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

async function request(path: string, init: RequestInit = {}): Promise<Response> {
  const response = await fetch(path, { ...init, headers: { ...init.headers, 'X-Versine-Token': token } });
  if (!response.ok) throw new ServerError(response.status, (await response.text()) || response.statusText);
  return response;
}

export async function getResult(): Promise<Result> {
  return (await request('api/result')).json();
}

export async function getProgress(): Promise<Progress> {
  return (await request('api/progress')).json();
}

export async function getValues(x: number): Promise<Values> {
  return (await request(`api/values?x=${x}`)).json();
}

/** uint32 n, uint32 kind, float64 x[n], float32 arrays of n: 0 min, max; 1 and lower, upper; 2 value; 3 value, sigma. */
export async function getSeries(id: string, from?: number, to?: number, buckets?: number): Promise<Series> {
  const query = new URLSearchParams();
  if (from !== undefined) query.set('from', String(from));
  if (to !== undefined) query.set('to', String(to));
  if (buckets !== undefined) query.set('buckets', String(buckets));
  const suffix = query.size > 0 ? `?${query}` : '';
  const buffer = await (await request(`api/series/${encodeURIComponent(id)}${suffix}`)).arrayBuffer();
  const [n, kind] = new Uint32Array(buffer, 0, 2);
  const floats = (index: number) => new Float32Array(buffer, 8 + 8 * n + 4 * n * index, n);
  const x = new Float64Array(buffer, 8, n);
  if (kind < 2) return { x, min: floats(0), max: floats(1), lower: kind ? floats(2) : null, upper: kind ? floats(3) : null };
  const value = floats(0);
  if (kind === 2) return { x, min: value, max: value, lower: null, upper: null };
  const sigma = floats(1);
  const bound = (sign: number) => Float32Array.from(value, (v, i) => v + sign * 1.96 * sigma[i]);
  return { x, min: value, max: value, lower: bound(-1), upper: bound(1), sigma };
}

export async function getMarks(): Promise<unknown[]> {
  return (await request('api/marks')).json();
}

export async function putMarks(marks: unknown[]): Promise<void> {
  await request('api/marks', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(marks) });
}

/** float64 origin, uint32 groups, uint32 points, uint32 start[groups + 1], float32 places. */
export async function getMap(part: string): Promise<Points> {
  const buffer = await (await request(`api/map/${part}`)).arrayBuffer();
  const [easting, northing] = new Float64Array(buffer, 0, 2);
  const [groups, points] = new Uint32Array(buffer, 16, 2);
  return { origin: [easting, northing], start: new Uint32Array(buffer, 24, groups + 1), places: new Float32Array(buffer, 28 + 4 * groups, 2 * points) };
}

/** The background of a window in the result's map, as a picture; null where there is none. */
export async function getBackground([west, south, east, north]: number[], width: number, height: number): Promise<ImageBitmap | null> {
  const query = new URLSearchParams(Object.entries({ west, south, east, north, width, height }).map(([k, v]) => [k, String(v)]));
  try {
    return await createImageBitmap(await (await request(`api/background?${query}`)).blob());
  } catch (error) {
    if (error instanceof ServerError) return null;
    throw error;
  }
}

export async function getConstraints(): Promise<Constraint[]> {
  return (await request('api/constraints')).json();
}

/** Writes the reviewer's constraints beside the result; the result itself is never changed. */
export async function putConstraints(list: Constraint[]): Promise<void> {
  await request('api/constraints', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(list) });
}

/** Opens the report in a tab of its own. A link could not send the token, so the page fetches it. */
export async function openReport(): Promise<void> {
  const text = await (await request('api/report')).text();
  open(URL.createObjectURL(new Blob([text], { type: 'text/html' })), '_blank');
}
