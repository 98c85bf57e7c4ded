// SPDX-License-Identifier: Apache-2.0
import { openReport } from './api';
import { Chainage } from './chainage';
import type { Result, StripInfo, Survey } from './contract';
import { ExceedanceTable } from './exceedances';
import { exportCsv, exportPng } from './export';
import { bindKeys, showHelp } from './keys';
import { Marks } from './marks';
import { Overview } from './overview';
import { packUpPanel } from './packup';
import { Plan } from './plan';
import { SeriesStore } from './pyramid';
import { Strip } from './strips';
import { element, speak } from './text';
import { nextTheme } from './theme';
import { View } from './view';

const tabs: { id: StripInfo['tab']; title: string }[] = [
  { id: 'strips', title: 'Strips' },
  { id: 'versines', title: 'Versines and checks' },
  { id: 'difference', title: 'Forward / backward' },
  { id: 'adjustment', title: 'Adjustment' },
];

/** The screen of a survey: plan and faults on the left, strips in the middle, values on the right. */
export class SurveyScreen {
  private readonly survey: Survey;
  private readonly chainage: Chainage;
  private readonly view: View;
  private readonly strips: Strip[];
  private readonly stores = new Map<string, SeriesStore>();
  private readonly plan: Plan;
  private readonly overview: Overview;
  private readonly table: ExceedanceTable;
  private readonly marks: Marks;
  private readonly readout = element('output', { class: 'km', 'aria-label': 'Place of the cursor' });
  private readonly centre = element('div', { class: 'strips' });
  private tab: StripInfo['tab'] = 'strips';
  private limitsScale = false;
  private pending = 0;

  constructor(
    private readonly root: HTMLElement,
    private readonly result: Result,
  ) {
    this.survey = result.survey!;
    this.chainage = new Chainage(this.survey.chainage);
    this.view = new View(this.survey.x.from, this.survey.x.to);
    const store = (id: string) => {
      if (!this.stores.has(id)) this.stores.set(id, new SeriesStore(id, this.survey.x.count));
      return this.stores.get(id)!;
    };
    this.strips = this.survey.strips.map(
      (info) =>
        new Strip(info, store(info.id), this.survey.compare ? store(`compare:${info.id}`) : null, this.chainage, this.survey.exceedances.filter((e) => e.strip === info.id), {
          cursor: (x) => x !== null && this.view.moveCursor(x),
          zoom: (from, to) => this.view.zoom(from, to),
        }),
    );
    this.plan = new Plan(this.survey.plan, this.survey.exceedances, this.survey.controlPoints, result.crs, (x) => this.view.goTo(x));
    this.overview = new Overview(this.view, this.chainage, this.survey.exceedances);
    this.table = new ExceedanceTable(this.survey.exceedances, this.chainage, (e) => {
      this.view.goTo(e.peakAt);
      speak(`${e.class}, ${e.title}, ${this.chainage.text(e.peakAt)}, ${e.peak.toFixed(1)} ${e.unit}`);
    });
    this.marks = new Marks(result.title, this.chainage);
  }

  async start(): Promise<void> {
    this.layout();
    await Promise.all(this.visible().map((s) => s.store.load()));
    await Promise.all(this.visible().map((s) => (this.survey.compare ? this.stores.get(`compare:${s.info.id}`)?.load() : undefined)));
    this.rebuild();
    this.view.onChange(() => this.changed());
    new ResizeObserver(() => this.rebuild()).observe(this.centre);
    this.keys();
    performance.mark('versine-ready');
    document.documentElement.dataset.ready = 'true';
  }

  private visible(): Strip[] {
    return this.strips.filter((s) => s.info.tab === this.tab);
  }

  private layout(): void {
    const header = element('header');
    const verdict = element('strong', { class: `verdict ${this.result.verdict.accepted === false ? 'bad' : this.result.verdict.accepted ? 'good' : ''}` }, this.result.verdict.text);
    const theme = element('button', { type: 'button' }, 'Theme D');
    theme.addEventListener('click', () => this.retheme());
    const help = element('button', { type: 'button' }, 'Keys ?');
    help.addEventListener('click', showHelp);
    const report = element('button', { type: 'button' }, 'Report P');
    report.addEventListener('click', () => void openReport());
    report.hidden = !this.result.report;
    header.append(element('h1', {}, this.result.title), verdict, element('span', { class: 'subtitle' }, this.result.subtitle), this.readout, theme, help, report);

    const left = element('aside', { 'aria-label': 'Plan and exceedances' });
    left.append(this.plan.element, packUpPanel(this.survey, this.result), this.table.element, this.marks.element);

    const bar = element('div', { role: 'tablist', class: 'tabs', 'aria-label': 'Groups of strips' });
    for (const { id, title } of tabs.filter((t) => this.survey.strips.some((s) => s.tab === t.id))) {
      const button = element('button', { role: 'tab', type: 'button', 'aria-selected': String(id === this.tab) }, title);
      button.addEventListener('click', () => this.openTab(id, bar));
      bar.append(button);
    }
    const main = element('main');
    main.append(bar, this.centre);
    const footer = element('footer');
    footer.append(this.overview.element);
    this.root.replaceChildren(header, left, main, footer);
    this.root.className = 'survey';
    this.fillCentre();
  }

  private fillCentre(): void {
    this.centre.replaceChildren(...this.visible().map((s) => s.element));
    if (this.survey.strips.length === 0) {
      this.centre.append(element('p', { class: 'empty' }, 'This result has a trajectory but no track geometry. Add [geometry] to the job and run it again.'));
    }
  }

  private async openTab(id: StripInfo['tab'], bar: HTMLElement): Promise<void> {
    for (const strip of this.visible()) strip.destroy();
    this.tab = id;
    [...bar.children].forEach((b) => b.setAttribute('aria-selected', String(b.textContent === tabs.find((t) => t.id === id)!.title)));
    await Promise.all(this.visible().map((s) => s.store.load()));
    this.fillCentre();
    this.rebuild();
  }

  private rebuild(): void {
    const strips = this.visible();
    const height = Math.max(48, (this.centre.clientHeight - 26) / Math.max(strips.length, 1));
    strips.forEach((strip, i) => {
      const width = this.centre.clientWidth - 172 - 116;
      strip.build(Math.max(width, 100), height, this.view.from, this.view.to, i + 1 === strips.length);
      strip.setLimitsScale(this.limitsScale);
    });
    this.draw();
  }

  private changed(): void {
    cancelAnimationFrame(this.pending);
    this.pending = requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    const { from, to, cursor } = this.view;
    const spoken: string[] = [];
    for (const strip of this.visible()) {
      void strip.show(from, to);
      strip.moveCursor(cursor);
      spoken.push(strip.showCursor(cursor));
    }
    this.readout.textContent = `km ${this.chainage.text(cursor, to - from < 50 ? 2 : 0)}`;
    this.plan.show(from, to, cursor);
    this.overview.draw();
    speak(`${this.readout.textContent}. ${spoken.filter(Boolean).join('. ')}`);
  }

  private retheme(): void {
    nextTheme();
    this.plan.style();
    this.rebuild();
  }

  private keys(): void {
    const view = this.view;
    const pan = (by: number) => view.zoom(view.from + by, view.to + by);
    const zoom = (factor: number, at = view.cursor) => view.zoom(at - (at - view.from) * factor, at + (view.to - at) * factor);
    const step = () => Math.max(this.survey.x.step, (view.to - view.from) / 600);
    bindKeys({
      ArrowLeft: (shift) => view.moveCursor(view.cursor - (shift ? 10 : 1) * step()),
      ArrowRight: (shift) => view.moveCursor(view.cursor + (shift ? 10 : 1) * step()),
      '+': () => zoom(0.5),
      '-': () => zoom(2),
      PageUp: () => pan(-(view.to - view.from) * 0.9),
      PageDown: () => pan((view.to - view.from) * 0.9),
      Home: () => view.goTo(view.first),
      End: () => view.goTo(view.last),
      f: () => view.fit(),
      n: () => this.table.step(1),
      b: () => this.table.step(-1),
      y: () => {
        this.limitsScale = !this.limitsScale;
        for (const strip of this.visible()) strip.setLimitsScale(this.limitsScale);
      },
      g: () => this.askPlace(),
      m: () => this.marks.add(view.cursor),
      d: () => this.retheme(),
      p: () => this.result.report && openReport(),
      e: () => exportPng(this.visible(), this.result.title),
      c: () => exportCsv(this.visible(), view, this.chainage, this.result.title),
      '?': showHelp,
    });
    this.centre.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        if (event.shiftKey) return pan(((event.deltaY || event.deltaX) / 800) * (view.to - view.from));
        const box = this.centre.getBoundingClientRect();
        const share = Math.min(Math.max((event.clientX - box.left - 172 - 44) / (box.width - 172 - 116 - 44), 0), 1);
        zoom(Math.exp(event.deltaY / 400), view.from + share * (view.to - view.from));
      },
      { passive: false },
    );
    this.centre.addEventListener('dblclick', () => view.fit());
  }

  private askPlace(): void {
    const dialog = element('dialog', { 'aria-label': 'Go to a kilometre' });
    const form = element('form', { method: 'dialog' });
    const input = element('input', { id: 'place', placeholder: '16+104', autocomplete: 'off' });
    const note = element('p', { role: 'alert' });
    form.append(element('label', { for: 'place' }, 'Go to km'), input, note);
    form.addEventListener('submit', (event) => {
      const posted = Chainage.parse(input.value);
      const places = posted === null ? [] : this.chainage.places(posted);
      const inside = places.filter((x) => x >= this.view.first && x <= this.view.last);
      if (inside.length === 0) {
        event.preventDefault();
        note.textContent = posted === null ? 'Write 16+104, 16.104 or 16104.' : 'This kilometre is not in the survey.';
        return;
      }
      // Where a kilometre is posted twice, the next one after the cursor.
      this.view.goTo(inside.find((x) => x > this.view.cursor + 0.5) ?? inside[0]);
    });
    dialog.append(form);
    dialog.addEventListener('close', () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  }
}
