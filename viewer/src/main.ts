// SPDX-License-Identifier: Apache-2.0
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { getResult, ServerError } from './api';
import type { Result } from './contract';
import { SurveyScreen } from './survey';
import { initTheme } from './theme';
import { element } from './text';

const root = document.getElementById('app')!;

function explain(error: unknown): void {
  const missingToken = error instanceof ServerError && error.status === 401;
  const text = missingToken ? 'This page needs the full address that "versine view" printed: its last part is the key.' : String(error instanceof Error ? error.message : error);
  root.replaceChildren(element('p', { class: 'failure', role: 'alert' }, text));
}

async function show(result: Result): Promise<void> {
  document.title = `${result.title} · Versine`;
  await new SurveyScreen(root, result).start();
}

/** A running job is looked at again and again; the view stays where it is because the address holds it. */
async function watch(result: Result): Promise<void> {
  let running = result.running;
  while (running) {
    await new Promise((resolve) => setTimeout(resolve, 2000));
    const next = await getResult();
    running = next.running;
    await show(next);
  }
}

initTheme();
try {
  const result = await getResult();
  await show(result);
  await watch(result);
} catch (error) {
  explain(error);
}
