// SPDX-License-Identifier: Apache-2.0
import 'uplot/dist/uPlot.min.css';
import './style.css';
import { getProgress, getResult, ServerError } from './api';
import type { Progress, Result } from './contract';
import { GeorefScreen } from './georef';
import type { Screen } from './screen';
import { SurveyScreen } from './survey';
import { initTheme } from './theme';
import { element } from './text';
import { WaitingScreen } from './waiting';

const root = document.getElementById('app')!;

/** A screen a kind of result. */
const screens: Partial<Record<Result['kind'], (result: Result) => Screen>> = {
  survey: (result) => new SurveyScreen(root, result),
  georef: (result) => new GeorefScreen(root, result),
  waiting: (result) => new WaitingScreen(root, result),
};

function explain(error: unknown): void {
  const missingToken = error instanceof ServerError && error.status === 401;
  const text = missingToken ? 'This page needs the full address that "versine view" printed: its last part is the key.' : String(error instanceof Error ? error.message : error);
  root.className = '';
  root.replaceChildren(element('p', { class: 'failure', role: 'alert' }, text));
}

async function show(result: Result): Promise<Screen> {
  document.title = `${result.title} · Versine`;
  const make = screens[result.kind];
  if (!make) throw new Error(`This page has no screen for a result of the kind ${result.kind}.`);
  const screen = make(result);
  await screen.start();
  return screen;
}

function tell(screen: Screen, progress: Progress): void {
  if (screen instanceof WaitingScreen) screen.update(progress);
  const chip = root.querySelector<HTMLElement>('.progress');
  if (chip) chip.textContent = progress.running ? `running: ${progress.stage ?? ''} ${Math.round(100 * (progress.fraction ?? 0))} %` : '';
}

/** Looks every two seconds whether a job is running and whether its result has come; the address keeps the view. */
async function follow(screen: Screen, generation: number): Promise<void> {
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, 2000));
    try {
      const progress = await getProgress();
      if (progress.generation !== generation) {
        generation = progress.generation;
        screen.dispose();
        screen = await show({ ...(await getResult()), background: progress.background });
      }
      tell(screen, progress);
    } catch (error) {
      // The program has ended: what is on the page can still be looked at.
      const chip = root.querySelector<HTMLElement>('.progress');
      if (chip) chip.textContent = error instanceof ServerError ? error.message : 'versine view has ended';
    }
  }
}

initTheme();
try {
  const [progress, result] = await Promise.all([getProgress(), getResult()]);
  const screen = await show({ ...result, background: progress.background });
  tell(screen, progress);
  void follow(screen, progress.generation);
} catch (error) {
  explain(error);
}
