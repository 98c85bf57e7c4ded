// SPDX-License-Identifier: Apache-2.0
import './georef.css';
import { openReport } from './api';
import { TimeAxis, type Axis } from './axis';
import { Chainage } from './chainage';
import { Choice } from './choice';
import type { Georef, Journey, Result, Stretch } from './contract';
import { differenceList } from './differences';
import { askPlace } from './dialogs';
import { showExports } from './export';
import { GeorefMap } from './georef_map';
import { header } from './header';
import { bindKeys, showHelp } from './keys';
import { ProbabilityStrip } from './probability';
import { lowerBound, SeriesStore } from './pyramid';
import { Review } from './review';
import type { Screen } from './screen';
import { labelWidth, scaleWidth, Strip, valueWidth } from './strips';
import { StretchTable, type Case } from './stretches';
import { element, minus, percent, shortName, speak } from './text';
import { nextTheme } from './theme';
import { View } from './view';

const stripHeight = 62;

/** The screen of a georeferencing: map, what is uncertain, and one journey over time or distance. */
export class GeorefScreen implements Screen {
  private readonly georef: Georef;
  private readonly review = new Review();
  private readonly map: GeorefMap;
  private readonly table: StretchTable;
  private readonly choice: Choice;
  private readonly readout = element('output', { class: 'km', 'aria-label': 'Place of the cursor' });
  private readonly centre = element('div', { class: 'strips', id: 'strips', tabindex: '0', role: 'region', 'aria-label': 'Strips of the journey' });
  private readonly journeys = element('select', { 'aria-label': 'Journey' });
  private readonly track = element('p', { class: 'track' });
  private readonly release = new AbortController();
  private readonly resized = new ResizeObserver(() => this.rebuild());
  private ofJourney = new AbortController();
  private journey: Journey | null = null;
  private overDistance = false;
  private axis: Axis = new TimeAxis();
  private view: View;
  private strips: Strip[] = [];
  private probability: ProbabilityStrip | null = null;
  private stores: Record<'distance' | 'sigma' | 'across', SeriesStore> | null = null;
  private pending = 0;
  private width = 100;

  constructor(
    private readonly root: HTMLElement,
    private readonly result: Result,
  ) {
    this.georef = result.georef!;
    this.view = new View(0, 1, this.ofJourney.signal);
    this.map = new GeorefMap(this.georef, result.crs, result.background, (track, place) => this.picked(track, place));
    this.table = new StretchTable(this.georef.journeys, this.review, (c) => void this.openStretch(c));
    this.choice = new Choice(this.review, this.georef.constraintsFile, { preview: (path) => this.map.choose(path), decided: () => this.table.show() });
  }

  async start(): Promise<void> {
    const drawn = this.map.load();
    await this.review.load();
    this.table.show();
    this.layout();
    this.keys();
    const first = this.georef.journeys[0];
    if (first) await this.open(first);
    else this.map.fit();
    await drawn;
    await this.map.painted();
    this.resized.observe(this.centre);
    performance.mark('versine-ready');
    document.documentElement.dataset.ready = 'true';
  }

  dispose(): void {
    this.release.abort();
    this.ofJourney.abort();
    this.resized.disconnect();
    cancelAnimationFrame(this.pending);
    for (const strip of this.strips) strip.destroy();
    this.map.dispose();
  }

  private layout(): void {
    const top = header(this.result, this.readout, { theme: () => this.retheme(), help: showHelp, exports: () => this.exports(), report: () => void openReport() });
    for (const j of this.georef.journeys) {
      const best = j.hypotheses[0];
      this.journeys.append(element('option', { value: j.id }, `${shortName(j.recording)} · ${j.number} · ${(j.length / 1000).toFixed(2)} km · ${percent(best?.probability ?? null)}`));
    }
    this.journeys.addEventListener('change', () => void this.open(this.georef.journeys.find((j) => j.id === this.journeys.value)!));
    const side = element('aside', { 'aria-label': 'What is uncertain' });
    const pick = element('div', { class: 'pick' });
    pick.append(this.journeys);
    const differences = differenceList(this.georef, (journey, d) => void this.openPlace(journey, d.fromM, d.toM));
    side.append(pick, this.track, differences, this.table.element, this.choice.element, this.failures());
    const main = element('main');
    main.append(this.centre);
    this.root.replaceChildren(top, this.map.element, side, main);
    this.root.className = 'survey georef';
    this.root.setAttribute('aria-busy', 'false');
  }

  private failures(): HTMLElement {
    const out = element('section', { class: 'failures', 'aria-label': 'Recordings without a result' });
    const { failures, network } = this.georef;
    const lines = [...failures.map((f) => `${f.recording}: ${f.error}`), ...network.warnings];
    if (lines.length === 0) return out;
    const list = element('ul');
    for (const text of lines.slice(0, 50)) list.append(element('li', {}, text));
    out.append(element('h2', {}, `Failed recordings (${failures.length}), warnings of the map (${network.warnings.length})`), list);
    return out;
  }

  /** Shows a journey; the axis stays what it was. */
  private async open(journey: Journey, at?: { from: number; to: number }): Promise<void> {
    if (this.journey && this.journey !== journey) history.replaceState(null, '', '#'); // a bookmark is of the first
    this.journey = journey;
    this.journeys.value = journey.id;
    this.ofJourney.abort();
    this.ofJourney = new AbortController();
    const best = journey.hypotheses[0];
    const [first, last] = this.overDistance ? [best?.from ?? 0, best?.to ?? journey.length] : [0, journey.to - journey.from];
    this.axis = this.overDistance ? new Chainage([{ from: first, to: last, posted: first, sign: 1 }]) : new TimeAxis();
    this.view = new View(first, Math.max(last, first + 1), this.ofJourney.signal);
    const prefix = `${journey.id}:${this.overDistance ? 'd' : 't'}:`;
    this.stores = { distance: new SeriesStore(`${journey.id}:t:distance`, journey.count), sigma: new SeriesStore(`${prefix}sigma`, journey.count), across: new SeriesStore(`${prefix}across`, journey.fixes) };
    for (const strip of this.strips) strip.destroy();
    this.strips = this.georef.strips.map((info) => new Strip({ ...info, count: journey.count }, new SeriesStore(prefix + info.id, journey.count), { compare: null, companion: null }, this.axis, [], { cursor: (x) => this.view.moveCursor(x), zoom: (a, b) => this.view.zoom(a, b) }));
    this.probability = new ProbabilityStrip(journey, (s) => this.ends(s), first, last, (x) => this.view.moveCursor(x));
    this.centre.replaceChildren(this.probability.element, ...this.strips.map((s) => s.element));
    this.choice.about(journey, null);
    this.view.onChange(() => this.changed());
    await Promise.all([...Object.values(this.stores), ...this.strips.map((s) => s.store)].map((s) => s.load()));
    if (this.journey !== journey) return;
    if (at) this.view.zoom(at.from, at.to);
    this.rebuild();
    await this.map.show(journey);
    if (at && best) this.map.zoomTo(best, ...this.onPath(at));
    document.documentElement.dataset.journey = journey.id;
    document.documentElement.dataset.loaded = 'strips';
  }

  private ends(s: Stretch): [number, number] {
    return this.overDistance ? [s.fromM, s.toM] : [s.from - this.journey!.from, s.to - this.journey!.from];
  }

  private async openStretch({ journey, stretch }: Case): Promise<void> {
    const before = this.journey;
    this.journey = journey;
    const [a, b] = this.ends(stretch);
    this.journey = before;
    const margin = Math.max(0.5 * (b - a), 10);
    const around = { from: a - margin, to: b + margin };
    if (journey !== before) await this.open(journey, around);
    else {
      this.view.zoom(around.from, around.to);
      this.map.zoomTo(journey.hypotheses[0], stretch.fromM - 50, stretch.toM + 50);
    }
    this.view.moveCursor((a + b) / 2);
    this.choice.about(journey, stretch);
    speak(`${percent(stretch.probability)} for ${stretch.alternative.join(' ')} instead of ${stretch.taken.join(' ')}`);
  }

  /** Shows a piece of path 1 on map and strips. */
  private async openPlace(journey: Journey, from: number, to: number): Promise<void> {
    if (journey !== this.journey) await this.open(journey);
    const [a, b] = this.overDistance ? [from, to] : [this.timeAt(from), this.timeAt(to)];
    const margin = Math.max(0.5 * (b - a), 10);
    this.view.zoom(a - margin, b + margin);
    this.view.moveCursor((a + b) / 2);
    this.map.zoomTo(journey.hypotheses[0], from - 50, to + 50);
  }

  /** Place on path 1 of a place of the axis. */
  private onPath({ from, to }: { from: number; to: number }): [number, number] {
    if (this.overDistance) return [from, to];
    return [this.stores!.distance.at(from)?.value ?? 0, this.stores!.distance.at(to)?.value ?? 0];
  }

  private picked(track: string | null, place: number | null): void {
    if (track) speak(`track ${track}`);
    if (track) this.track.textContent = `Track ${track}`;
    if (place === null || !this.journey) return;
    this.view.moveCursor(this.overDistance ? place : this.timeAt(place));
  }

  private timeAt(distance: number): number {
    const all = this.stores!.distance.now(-Infinity, Infinity);
    return all.x[Math.min(lowerBound(all.min, distance), all.x.length - 1)] ?? 0;
  }

  private toggle(): void {
    if (!this.journey || !this.stores?.distance.loaded) return;
    const at = this.overDistance ? this.timeAt(this.view.cursor) : this.onPath({ from: this.view.cursor, to: this.view.cursor })[0];
    this.overDistance = !this.overDistance;
    history.replaceState(null, '', '#');
    void this.open(this.journey).then(() => this.view.moveCursor(at));
  }

  private rebuild(): void {
    this.width = Math.max(this.centre.clientWidth - labelWidth - valueWidth, 100);
    this.strips.forEach((strip, i) => strip.build(this.width, stripHeight, this.view.from, this.view.to, i + 1 === this.strips.length));
    this.draw();
  }

  private changed(): void {
    cancelAnimationFrame(this.pending);
    this.pending = requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    const { from, to, cursor } = this.view;
    const journey = this.journey;
    if (!journey || !this.stores?.distance.loaded || !this.probability) return;
    const spoken = [this.probability.draw(from, to, cursor, this.width, stripHeight)];
    for (const strip of this.strips) {
      void strip.show(from, to);
      strip.moveCursor(cursor);
      if (strip.store.loaded) spoken.push(strip.showReading(strip.store.at(cursor), null));
    }
    const distance = this.onPath({ from: cursor, to: cursor })[0];
    const sigma = this.stores.sigma.loaded ? (this.stores.sigma.at(cursor)?.value ?? NaN) : NaN;
    const across = this.stores.across.loaded ? (this.stores.across.at(cursor)?.sigma ?? NaN) : NaN;
    this.map.moveCursor(distance, sigma, across);
    const track = journey.hypotheses[0]?.tracks.find((t) => distance >= t.from && distance <= t.to);
    this.readout.textContent = `${this.axis.readout(cursor)} · ${minus(distance, 1)} m`;
    this.track.textContent = track ? `Track ${track.id}, ${minus(distance - track.from, 1)} m from where the path enters it ± ${(1.96 * sigma).toFixed(1)} m` : '';
    speak(`${this.readout.textContent}. ${this.track.textContent} ${spoken.filter(Boolean).join('. ')}`);
  }

  private retheme(): void {
    nextTheme();
    this.map.style();
    this.rebuild();
  }

  private exports(): void {
    const redraw = () => {
      this.map.style();
      this.rebuild();
    };
    showExports({ strips: this.strips, view: this.view, axis: this.axis, result: this.result, marks: [], map: this.map.canvas, redraw });
  }

  private keys(): void {
    const width = () => this.view.to - this.view.from;
    const zoom = (factor: number, at = this.view.cursor) => this.view.zoom(at - (at - this.view.from) * factor, at + (this.view.to - at) * factor);
    const step = (shift: boolean) => (shift ? 10 : 1) * Math.max(0.1, width() / 600);
    const pan = (by: number) => this.view.zoom(this.view.from + by, this.view.to + by);
    const digits = Object.fromEntries([1, 2, 3, 4, 5, 6, 7, 8, 9].map((n) => [String(n), () => this.choice.choose(n)]));
    bindKeys(this.release.signal, {
      ...digits,
      ArrowLeft: (shift) => this.view.moveCursor(this.view.cursor - step(shift)),
      ArrowRight: (shift) => this.view.moveCursor(this.view.cursor + step(shift)),
      '+': () => zoom(0.5),
      '-': () => zoom(2),
      PageUp: () => pan(-0.9 * width()),
      PageDown: () => pan(0.9 * width()),
      Home: () => this.view.goTo(this.view.first, width()),
      End: () => this.view.goTo(this.view.last, width()),
      f: () => this.view.fit(),
      n: () => this.table.step(1),
      b: () => this.table.step(-1),
      t: () => this.toggle(),
      u: () => void this.choice.undo(),
      // On a button Enter is that button's own.
      Enter: () => (document.activeElement instanceof HTMLButtonElement ? document.activeElement.click() : void this.choice.confirm()),
      g: () => askPlace(this.axis, this.view),
      d: () => this.retheme(),
      e: () => this.exports(),
      p: () => this.result.report && openReport(),
      '?': showHelp,
    });
    this.centre.addEventListener('wheel', (event) => {
      const inside = event.target instanceof Element && event.target.closest('.strip-box');
      if (!inside || event.ctrlKey) return;
      event.preventDefault();
      if (event.shiftKey) return pan(((event.deltaY || event.deltaX) / 800) * width());
      const box = inside.getBoundingClientRect();
      const share = Math.min(Math.max((event.clientX - box.left - scaleWidth) / (box.width - scaleWidth), 0), 1);
      zoom(Math.exp(event.deltaY / 400), this.view.from + share * width());
    }, { passive: false });
  }
}
