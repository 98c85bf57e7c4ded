// SPDX-License-Identifier: Apache-2.0
import type { Result, Series } from './contract';

// The token comes in the URL's fragment, which no server log and no referrer ever sees; it is kept for reloads of this
// tab and taken out of the address bar.
function readToken(): string {
  const match = /[#&]token=([0-9a-f]+)/.exec(location.hash);
  if (match) {
    sessionStorage.setItem('versine-token', match[1]);
    history.replaceState(null, '', location.pathname + location.hash.replace(/[#&]token=[0-9a-f]+/, ''));
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

export async function getJson<T>(path: string): Promise<T> {
  return (await request(path)).json();
}

export async function getText(path: string): Promise<string> {
  return (await request(path)).text();
}

/** Layout: uint32 n, uint32 hasSigma, then float64 x[n], float32 min[n], max[n], and lower[n], upper[n] if hasSigma. */
export async function getSeries(id: string, from?: number, to?: number, buckets?: number): Promise<Series> {
  const query = new URLSearchParams();
  if (from !== undefined) query.set('from', String(from));
  if (to !== undefined) query.set('to', String(to));
  if (buckets !== undefined) query.set('buckets', String(buckets));
  const suffix = query.size > 0 ? `?${query}` : '';
  const buffer = await (await request(`api/series/${encodeURIComponent(id)}${suffix}`)).arrayBuffer();
  const head = new Uint32Array(buffer, 0, 2);
  const n = head[0];
  const floats = (index: number) => new Float32Array(buffer, 8 + 8 * n + 4 * n * index, n);
  return {
    x: new Float64Array(buffer, 8, n),
    min: floats(0),
    max: floats(1),
    lower: head[1] ? floats(2) : null,
    upper: head[1] ? floats(3) : null,
  };
}

/** Writes the reviewer's constraints beside the result; the result itself is never changed. */
export async function putConstraints(body: unknown): Promise<void> {
  await request('api/constraints', {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify(body),
  });
}

/** Opens the report in a tab of its own. A link could not send the token, so the page fetches it. */
export async function openReport(): Promise<void> {
  const text = await getText('api/report');
  open(URL.createObjectURL(new Blob([text], { type: 'text/html' })), '_blank');
}
