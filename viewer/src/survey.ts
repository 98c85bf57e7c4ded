// SPDX-License-Identifier: Apache-2.0
import { getValues, openReport } from './api';
import { TimeAxis, type Axis } from './axis';
import { Chainage } from './chainage';
import type { Result, StripInfo, Survey, Values } from './contract';
import { askPlace } from './dialogs';
import { ExceedanceTable } from './exceedances';
import { showExports } from './export';
import { header } from './header';
import { bindKeys, showHelp } from './keys';
import { Marks } from './marks';
import { Overview } from './overview';
import { packUpPanel } from './packup';
import { panels } from './panels';
import { Plan } from './plan';
import { SeriesStore } from './pyramid';
import type { Screen } from './screen';
import { labelWidth, scaleWidth, Strip, valueWidth, type Reading } from './strips';
import { element, minus, speak } from './text';
import { nextTheme } from './theme';
import { View } from './view';

const leastHeight = 50; // px of a strip; more strips than fit are scrolled

/** The screen of a survey: plan and faults on the left, strips in the middle, values on the right. */
export class SurveyScreen implements Screen {
  private readonly survey: Survey;
  private readonly axis: Axis;
  private readonly view: View;
  private readonly stores = new Map<string, SeriesStore>();
  private readonly strips: Strip[];
  private readonly plan: Plan;
  private readonly overview: Overview;
  private readonly table: ExceedanceTable;
  private readonly marks: Marks;
  private readonly readout = element('output', { class: 'km', 'aria-label': 'Place of the cursor' });
  private readonly centre = element('div', { class: 'strips', id: 'strips', role: 'tabpanel', tabindex: '0', 'aria-label': 'Strips' });
  private readonly bar = element('div', { role: 'tablist', class: 'tabs', 'aria-label': 'What is shown' });
  private readonly release = new AbortController(); // of every listener outside our own elements
  private readonly resized = new ResizeObserver(() => this.rebuild());
  private tab: string;
  private limitsScale = true;
  private pending = 0;
  private asked = 0;

  constructor(
    private readonly root: HTMLElement,
    private readonly result: Result,
  ) {
    const survey = (this.survey = result.survey!);
    this.axis = survey.axis === 'time' ? new TimeAxis() : new Chainage(survey.chainage);
    this.view = new View(survey.x.from, survey.x.to, this.release.signal);
    // The page of a running job is made anew with every stage: the open tab stays.
    const before = Object.hasOwn(result, 'partial') ? document.documentElement.dataset.tab : undefined;
    this.tab = before ?? (survey.compare ? 'difference' : (survey.tabs[0]?.id ?? 'notes'));
    this.strips = survey.strips.map((info) => this.strip(info));
    this.plan = new Plan(survey, result.crs, result.background, (x) => this.view.goTo(x));
    this.overview = new Overview(this.view, this.axis, survey.exceedances, survey.controlPoints);
    this.table = new ExceedanceTable(survey.exceedances, this.axis, (e) => {
      this.openTab(this.strips.find((s) => s.info.id === e.strip)?.info.tab ?? this.tab);
      this.view.goTo(e.peakAt, Math.min(this.view.to - this.view.from, 400));
      speak(`${e.level}, ${e.title}, ${this.axis.readout(e.peakAt)}, ${minus(e.peak, e.digits)} ${e.unit}`);
    });
    this.marks = new Marks(result.title, this.axis, (x) => this.view.goTo(x));
  }

  private strip(info: StripInfo): Strip {
    const store = (id: string) => {
      if (!this.stores.has(id)) this.stores.set(id, new SeriesStore(id, info.count));
      return this.stores.get(id)!;
    };
    const compared = this.survey.compare !== undefined && info.tab !== 'difference' && info.tab !== 'adjustment';
    return new Strip(
      info,
      store(info.id),
      { compare: compared ? store(`compare:${info.id}`) : null, companion: info.companion ? store(info.companion.id) : null },
      this.axis,
      this.survey.exceedances.filter((e) => e.strip === info.id),
      { cursor: (x) => this.view.moveCursor(x), zoom: (from, to) => this.view.zoom(from, to) },
    );
  }

  async start(): Promise<void> {
    this.layout();
    this.keys();
    await this.show();
    this.view.onChange(() => this.changed());
    this.resized.observe(this.centre);
    performance.mark('versine-ready');
    document.documentElement.dataset.ready = 'true';
    void this.marks.load();
    this.loadAll();
  }

  dispose(): void {
    // What grows is seen as a whole again, unless one has looked closer.
    const { from, to, first, last } = this.view;
    if (this.result.partial !== undefined && from <= first && to >= last) history.replaceState(null, '', '#');
    this.release.abort();
    this.resized.disconnect();
    cancelAnimationFrame(this.pending);
    for (const strip of this.strips) strip.destroy();
    this.plan.dispose();
  }

  private visible(): Strip[] {
    return this.strips.filter((s) => s.info.tab === this.tab);
  }

  private layout(): void {
    const top = header(this.result, this.readout, {
      theme: () => this.retheme(),
      help: showHelp,
      exports: () => this.exports(),
      report: () => void openReport(),
    });
    const left = element('aside', { 'aria-label': 'Plan and exceedances' });
    left.append(this.plan.element, packUpPanel(this.survey.packUp, this.result.partial !== undefined), this.table.element, this.marks.element);
    const all = [...this.survey.tabs, ...panels.filter((p) => p.has(this.result)).map(({ id, title }) => ({ id, title }))];
    for (const { id, title } of all) {
      const button = element('button', { role: 'tab', type: 'button', 'data-tab': id, 'aria-controls': 'strips' }, title);
      button.addEventListener('click', () => this.openTab(id));
      this.bar.append(button);
    }
    this.bar.addEventListener('keydown', (event) => this.walkTabs(event));
    const main = element('main');
    main.append(this.bar, this.centre);
    const footer = element('footer');
    footer.append(this.overview.element);
    this.root.replaceChildren(top, left, main, footer);
    this.root.className = 'survey';
    this.root.setAttribute('aria-busy', 'false');
  }

  /** Left and right walk the tabs while one has the focus, as a tab list should. */
  private walkTabs(event: KeyboardEvent): void {
    const by = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (by === 0) return;
    event.preventDefault();
    event.stopPropagation();
    const tabs = [...this.bar.children] as HTMLElement[];
    const next = tabs[(tabs.findIndex((t) => t.dataset.tab === this.tab) + by + tabs.length) % tabs.length];
    this.openTab(next.dataset.tab!);
    next.focus();
  }

  private openTab(id: string): void {
    if (id === this.tab) return;
    document.documentElement.dataset.tab = id;
    for (const strip of this.visible()) strip.destroy();
    this.tab = id;
    void this.show();
    this.loadAll();
  }

  /** Fills the middle with the tab's strips, or its panel. */
  private async show(): Promise<void> {
    for (const button of this.bar.querySelectorAll<HTMLElement>('[role=tab]')) {
      const on = button.dataset.tab === this.tab;
      button.setAttribute('aria-selected', String(on));
      button.tabIndex = on ? 0 : -1;
    }
    const panel = panels.find((p) => p.id === this.tab);
    this.centre.replaceChildren(...(panel ? [panel.make(this.result, this.axis, (x) => this.view.goTo(x))] : this.visible().map((s) => s.element)));
    this.centre.scrollTop = 0;
    await this.rebuild();
  }

  private rebuild(): Promise<unknown> {
    const strips = this.visible();
    const room = Math.floor((this.centre.clientHeight - 26) / Math.max(strips.length, 1));
    const height = Math.min(Math.max(leastHeight, room), 170);
    const width = Math.max(this.centre.clientWidth - labelWidth - valueWidth, 100);
    strips.forEach((strip, i) => {
      strip.build(width, height, this.view.from, this.view.to, i + 1 === strips.length);
      strip.setLimitsScale(this.limitsScale);
    });
    return this.draw();
  }

  /** All samples of what is seen, one after another, so that the first picture has the line for itself. */
  private async loadAll(): Promise<void> {
    for (const strip of this.visible()) for (const store of strip.stores) await store.load();
    document.documentElement.dataset.loaded = this.tab;
    this.changed();
  }

  private changed(): void {
    cancelAnimationFrame(this.pending);
    this.pending = requestAnimationFrame(() => void this.draw());
  }

  private async draw(): Promise<void> {
    const { from, to, cursor } = this.view;
    this.readout.textContent = this.axis.readout(cursor, to - from < 50 ? 2 : 0);
    this.plan.show(from, to, cursor);
    this.overview.draw();
    const drawn = this.visible().map((strip) => strip.show(from, to));
    for (const strip of this.visible()) strip.moveCursor(cursor);
    void this.read(cursor);
    await Promise.all(drawn);
  }

  /** Values at the cursor, from memory or from the server, which has every sample. */
  private async read(cursor: number): Promise<void> {
    const turn = ++this.asked;
    const strips = this.visible();
    const local = strips.every((s) => s.stores.every((store) => store.loaded));
    const remote: Values = local || strips.length === 0 ? {} : await getValues(cursor);
    if (turn !== this.asked) return;
    const reading = (store: SeriesStore | undefined): Reading | null => {
      if (!store) return null;
      if (store.loaded) return store.at(cursor);
      const pair = remote[store.id];
      return pair && pair[0] !== null ? { value: pair[0], sigma: pair[1] ?? NaN } : null;
    };
    const spoken = strips.map((s) => s.showReading(reading(s.store), reading(this.stores.get(s.info.companion?.id ?? ''))));
    speak(`${this.readout.textContent}. ${spoken.filter(Boolean).join('. ')}`);
  }

  private retheme(): void {
    nextTheme();
    this.plan.style();
    void this.rebuild();
  }

  private exports(): void {
    showExports({ strips: this.visible(), view: this.view, axis: this.axis, result: this.result, marks: this.marks.places(), redraw: () => { this.plan.style(); void this.rebuild(); } });
  }

  private keys(): void {
    const view = this.view;
    const width = () => view.to - view.from;
    const pan = (by: number) => view.zoom(view.from + by, view.to + by);
    const zoom = (factor: number, at = view.cursor) => view.zoom(at - (at - view.from) * factor, at + (view.to - at) * factor);
    const step = (shift: boolean) => (shift ? 10 : 1) * Math.max(this.survey.x.step, width() / 600);
    bindKeys(this.release.signal, {
      ArrowLeft: (shift) => view.moveCursor(view.cursor - step(shift)),
      ArrowRight: (shift) => view.moveCursor(view.cursor + step(shift)),
      '+': () => zoom(0.5),
      '-': () => zoom(2),
      PageUp: () => pan(-0.9 * width()),
      PageDown: () => pan(0.9 * width()),
      Home: () => view.goTo(view.first, width()),
      End: () => view.goTo(view.last, width()),
      f: () => view.fit(),
      n: () => this.table.step(1),
      b: () => this.table.step(-1),
      y: () => {
        this.limitsScale = !this.limitsScale;
        for (const strip of this.visible()) strip.setLimitsScale(this.limitsScale);
      },
      g: () => askPlace(this.axis, view),
      m: () => this.marks.add(view.cursor),
      d: () => this.retheme(),
      p: () => this.result.report && openReport(),
      e: () => this.exports(),
      '?': showHelp,
    });
    this.centre.addEventListener(
      'wheel',
      (event) => {
        const inside = event.target instanceof Element && event.target.closest('.strip-box');
        if (!inside || event.ctrlKey) return; // elsewhere the wheel scrolls
        event.preventDefault();
        if (event.shiftKey) return pan(((event.deltaY || event.deltaX) / 800) * width());
        const box = this.centre.getBoundingClientRect();
        const share = Math.min(Math.max((event.clientX - box.left - labelWidth - scaleWidth) / (this.centre.clientWidth - labelWidth - valueWidth - scaleWidth), 0), 1);
        zoom(Math.exp(event.deltaY / 400), view.from + share * width());
      },
      { passive: false },
    );
    this.centre.addEventListener('dblclick', () => view.fit());
  }
}
