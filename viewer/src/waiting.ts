// SPDX-License-Identifier: Apache-2.0
import type { Progress, Result } from './contract';
import type { Screen } from './screen';
import { element } from './text';

/** A job without a first result: how far it is, and what it has found so far. */
export class WaitingScreen implements Screen {
  private readonly list = element('ol');
  private readonly bar = element('progress', { max: '1', 'aria-label': 'Progress of this stage' });
  private readonly notes = element('ul');

  constructor(
    private readonly root: HTMLElement,
    private readonly result: Result,
  ) {}

  async start(): Promise<void> {
    this.root.className = 'waiting';
    const text = this.result.failure ? this.result.failure : 'The job is running. This page shows its result as soon as it is there.';
    this.root.replaceChildren(element('h1', {}, this.result.title), element('p', { role: this.result.failure ? 'alert' : 'status' }, text), this.list, this.bar, this.notes);
    this.bar.hidden = this.result.failure !== undefined && this.result.failure !== '';
    document.documentElement.dataset.ready = 'true';
  }

  update(progress: Progress): void {
    this.list.replaceChildren(...(progress.stages ?? []).map((s) => element('li', {}, `✓ ${s.stage}: ${s.seconds.toFixed(1)} s`)));
    if (progress.stage) this.list.append(element('li', { 'aria-current': 'step' }, `${progress.stage} …`));
    if (progress.fraction !== undefined) this.bar.value = progress.fraction;
    this.notes.replaceChildren(...(progress.notes ?? []).map((n) => element('li', {}, n)));
  }

  dispose(): void {}
}
