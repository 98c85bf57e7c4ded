// SPDX-License-Identifier: Apache-2.0
import 'ol/ol.css';
import Feature from 'ol/Feature';
import OlMap from 'ol/Map';
import OlView from 'ol/View';
import { ScaleLine } from 'ol/control';
import { defaults as interactions } from 'ol/interaction/defaults';
import LineString from 'ol/geom/LineString';
import MultiPoint from 'ol/geom/MultiPoint';
import Point from 'ol/geom/Point';
import Polygon from 'ol/geom/Polygon';
import VectorLayer from 'ol/layer/Vector';
import RenderFeature from 'ol/render/Feature';
import VectorSource from 'ol/source/Vector';
import { Circle, Fill, RegularShape, Stroke, Style, Text } from 'ol/style';
import { getMap } from './api';
import { backgroundLayer } from './background';
import type { Georef, Hypothesis, Journey, Points } from './contract';
import { mapMetres } from './plan';
import { along, apart, offset, part, type Place } from './polyline';
import { element } from './text';
import { css } from './theme';

const detail = [25, 120, Infinity]; // m per pixel up to which each level of the network is drawn
const group = 150; // lines of a coarse level in one feature: fewer, larger features draw faster

/** Lines of the network, `size` in a feature. Features that only draw, on the numbers as they came, take a third of the
 * time of features that could be changed. */
function network(points: Points, size: number, names: string[] = []): RenderFeature[] {
  const places = new Float64Array(points.places.length);
  for (let i = 0; i < places.length; ++i) places[i] = points.origin[i % 2] + points.places[i];
  const out: RenderFeature[] = [];
  const count = points.start.length - 1;
  for (let g = 0; g < count; g += size) {
    const [first, last] = [g, Math.min(g + size, count)];
    const base = 2 * points.start[first];
    const flat = places.subarray(base, 2 * points.start[last]) as unknown as number[];
    const ends = Array.from({ length: last - first }, (_, k) => 2 * points.start[first + k + 1] - base);
    out.push(new RenderFeature(size > 1 ? 'MultiLineString' : 'LineString', flat, ends, 2, { track: names[g] }, undefined));
  }
  return out;
}

/** Coordinates of each group. */
function lines(points: Points): number[][][] {
  const out: number[][][] = [];
  for (let g = 0; g + 1 < points.start.length; ++g) {
    const line: number[][] = [];
    for (let i = points.start[g]; i < points.start[g + 1]; ++i) line.push([points.origin[0] + points.places[2 * i], points.origin[1] + points.places[2 * i + 1]]);
    out.push(line);
  }
  return out;
}

/** Tracks that follow each other as one piece. */
function spans(tracks: { from: number; to: number }[]): { from: number; to: number }[] {
  const out: { from: number; to: number }[] = [];
  for (const { from, to } of tracks) {
    const last = out[out.length - 1];
    if (last && from - last.to < 0.01) last.to = to;
    else out.push({ from, to });
  }
  return out;
}

/** The network in grey, one journey's hypotheses as ribbons beside each other, its fixes, and the cursor with its 95 %. */
export class GeorefMap {
  readonly element = element('section', { class: 'georef-map', 'aria-label': 'Map' });
  private readonly map: OlMap;
  private readonly levels = detail.map((most, i) => new VectorLayer({ source: new VectorSource<RenderFeature>(), maxResolution: most, minResolution: i === 0 ? 0 : detail[i - 1] }));
  private readonly ribbons = new VectorSource();
  private readonly fixes = new VectorSource();
  private readonly pointer = new VectorSource();
  private journey: Journey | null = null;
  private chosen = 1;

  constructor(
    private readonly georef: Georef,
    crs: string,
    background: string | undefined,
    private readonly pick: (track: string | null, place: number | null) => void,
  ) {
    const target = element('div', { class: 'plan-map', role: 'img', 'aria-label': 'Network, paths and fixes; the tables beside it hold the same in words' });
    this.element.append(target);
    const projection = mapMetres(crs);
    this.map = new OlMap({
      target,
      layers: [...backgroundLayer(background, projection), ...this.levels, new VectorLayer({ source: this.fixes, maxResolution: 8 }), new VectorLayer({ source: this.ribbons }), new VectorLayer({ source: this.pointer })],
      controls: [new ScaleLine({ units: 'metric', minWidth: 60 })],
      interactions: interactions({ keyboard: false }),
      view: new OlView({ projection, center: [0, 0], resolution: 1, constrainResolution: false }),
    });
    this.map.on('singleclick', (event) => {
      const track = this.map.forEachFeatureAtPixel(event.pixel, (f) => (f.get('track') as string | undefined) ?? null, { hitTolerance: 6, layerFilter: (l) => l === this.levels[0] }) ?? null;
      const best = this.journey?.hypotheses[0];
      const found = best ? along(best, event.coordinate as Place) : null;
      this.pick(track, found && found.distance < 12 * this.map.getView().getResolution()! ? found.x : null);
    });
    this.style();
  }

  /** The whole network, the level that is needed first before the others. */
  async load(): Promise<void> {
    const first = this.georef.journeys.length > 0 ? 0 : 2;
    await this.loadLevel(first);
    void (async () => {
      await this.painted();
      for (const level of [0, 1, 2]) if (level !== first) await this.loadLevel(level);
    })();
  }

  private async loadLevel(level: number): Promise<void> {
    const points = await getMap(String(level));
    this.levels[level].getSource()!.addFeatures(level === 0 ? network(points, 1, this.georef.network.names) : network(points, group));
  }

  /** When what is there now has been drawn. */
  async painted(): Promise<void> {
    await new Promise<void>((done) => {
      this.map.once('rendercomplete', () => done());
      this.map.render();
    });
  }

  fit(): void {
    const [a, b, c, d] = this.georef.network.bounds;
    this.frame([a, b, c, d]);
  }

  async show(journey: Journey): Promise<void> {
    this.journey = journey;
    this.chosen = 1;
    this.drawRibbons();
    const best = journey.hypotheses[0];
    if (best) this.zoomTo(best, best.from, best.to);
    const points = await getMap(journey.id);
    if (this.journey !== journey) return;
    const [used, weak, rejected, pathOnly] = lines(points);
    this.fixes.clear();
    const dot = (fill: string, radius: number) => new Circle({ radius, fill: new Fill({ color: css(fill) }) });
    const cross = () => new RegularShape({ points: 4, radius: 5, radius2: 0, angle: Math.PI / 4, stroke: new Stroke({ color: css('--ial'), width: 1.2 }) });
    const hollow = () => new Circle({ radius: 3, stroke: new Stroke({ color: css('--muted'), width: 1 }) });
    for (const [places, image] of [[used, dot('--fix', 2)], [weak, dot('--muted', 2)], [rejected, cross()], [pathOnly, hollow()]] as const) {
      if (!places || places.length === 0) continue;
      const feature = new Feature(new MultiPoint(places));
      feature.setStyle(new Style({ image }));
      this.fixes.addFeature(feature);
    }
  }

  choose(path: number): void {
    this.chosen = path;
    this.drawRibbons();
  }

  zoomTo(path: Hypothesis, from: number, to: number): void {
    const places = part(path, from, to);
    if (places.length === 0) return;
    const e = places.map((p) => p[0]);
    const n = places.map((p) => p[1]);
    this.frame([Math.min(...e), Math.min(...n), Math.max(...e), Math.max(...n)]);
  }

  /** Along the track the 95 % interval as a bar, across it the fix's as an ellipse. */
  moveCursor(x: number, sigmaAlong: number, sigmaAcross: number): void {
    this.pointer.clear();
    const best = this.journey?.hypotheses[0];
    const at = best && apart(best, x);
    if (!best || !at) return;
    const half = 1.96 * (Number.isFinite(sigmaAlong) ? sigmaAlong : 0);
    const bar = new Feature(new LineString(part(best, x - half, x + half)));
    bar.setStyle(new Style({ stroke: new Stroke({ color: css('--cursor'), width: 9, lineCap: 'butt' }) }));
    const ring: number[][] = [];
    const across = 1.96 * (Number.isFinite(sigmaAcross) ? sigmaAcross : 0);
    for (let k = 0; k <= 48; ++k) {
      const [c, s] = [half * Math.cos((k * Math.PI) / 24), across * Math.sin((k * Math.PI) / 24)];
      ring.push([at.place[0] + c * at.direction[0] + s * at.direction[1], at.place[1] + c * at.direction[1] - s * at.direction[0]]);
    }
    const ellipse = new Feature(new Polygon([ring]));
    ellipse.setStyle(new Style({ stroke: new Stroke({ color: css('--cursor'), width: 1.5 }) }));
    const dot = new Feature(new Point(at.place));
    dot.setStyle(new Style({ image: new Circle({ radius: 7, stroke: new Stroke({ color: css('--cursor'), width: 2 }) }) }));
    this.pointer.addFeatures([ellipse, ...(half > 0 ? [bar] : []), dot]);
  }

  style(): void {
    for (const [i, layer] of this.levels.entries()) layer.setStyle(new Style({ stroke: new Stroke({ color: css('--network'), width: i === 0 ? 1.3 : 1 }) }));
    this.drawRibbons();
    if (this.journey) void this.show(this.journey);
  }

  get canvas(): HTMLCanvasElement | null {
    return this.element.querySelector('canvas');
  }

  dispose(): void {
    this.map.setTarget(undefined);
    this.map.dispose();
  }

  private frame(extent: number[]): void {
    requestAnimationFrame(() => {
      this.map.updateSize();
      this.map.getView().fit(extent, { padding: [40, 40, 40, 40], minResolution: 0.05 });
    });
  }

  /** Width tells the probability; the most probable path is solid, others dashed, numbered, and drawn where they are
   * on other tracks. Ribbons lie beside each other at every zoom. */
  private drawRibbons(): void {
    this.ribbons.clear();
    if (!this.journey) return;
    const best = this.journey.hypotheses[0];
    const shared = new Set(best?.tracks.map((t) => t.id));
    if (this.journey.other) this.drawOther(this.journey.other, shared);
    for (const h of [...this.journey.hypotheses].reverse()) {
      const pieces = h === best ? [part(h, h.from, h.to)] : spans(h.tracks.filter((t) => !shared.has(t.id))).map((t) => part(h, t.from, t.to));
      for (const piece of pieces) if (piece.length > 1) this.ribbons.addFeature(this.ribbon(h, piece, h === best));
    }
  }

  /** Path 1 of another run, dotted, where it is on other tracks. */
  private drawOther(other: Hypothesis, shared: Set<string>): void {
    for (const span of spans(other.tracks.filter((t) => !shared.has(t.id)))) {
      const piece = part(other, span.from, span.to);
      if (piece.length < 2) continue;
      const feature = new Feature(new LineString(piece));
      feature.setStyle((_f, resolution) => new Style({ geometry: new LineString(offset(piece, -4 * resolution)), stroke: new Stroke({ color: css('--text'), width: 3, lineDash: [1, 6] }) }));
      this.ribbons.addFeature(feature);
    }
  }

  private ribbon(h: Hypothesis, piece: Place[], best: boolean): Feature {
    const feature = new Feature(new LineString(piece));
    const width = 2 + 6 * h.probability;
    const on = h.path === this.chosen;
    feature.setStyle((_f, resolution) => {
      const shifted = new LineString(offset(piece, best ? 0 : (h.path - 1) * 4 * resolution));
      const color = css(on ? '--line' : '--other');
      const drawn = [new Style({ geometry: shifted, stroke: new Stroke({ color, width, lineDash: best ? undefined : [10, 6] }) })];
      if (!best) {
        const label = new Text({ text: String(h.path), font: 'bold 13px system-ui', fill: new Fill({ color: css('--text') }), stroke: new Stroke({ color: css('--background'), width: 3 }) });
        drawn.push(new Style({ geometry: new Point(shifted.getCoordinateAt(0.5)), text: label }));
      }
      return drawn;
    });
    return feature;
  }
}
