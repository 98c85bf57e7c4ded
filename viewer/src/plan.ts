// SPDX-License-Identifier: Apache-2.0
import 'ol/ol.css';
import Feature from 'ol/Feature';
import OlMap from 'ol/Map';
import OlView from 'ol/View';
import { ScaleLine } from 'ol/control';
import { extend } from 'ol/extent';
import { defaults as interactions } from 'ol/interaction/defaults';
import LineString from 'ol/geom/LineString';
import MultiLineString from 'ol/geom/MultiLineString';
import MultiPoint from 'ol/geom/MultiPoint';
import Point from 'ol/geom/Point';
import VectorLayer from 'ol/layer/Vector';
import Projection from 'ol/proj/Projection';
import VectorSource from 'ol/source/Vector';
import { Fill, RegularShape, Circle, Stroke, Style } from 'ol/style';
import { backgroundLayer } from './background';
import { lowerBound } from './pyramid';
import type { Polyline, Survey } from './contract';
import { element } from './text';
import { css, limitStyle } from './theme';

/** Projected metres are drawn as they are: no tiles, no Mercator. */
export const mapMetres = (code: string) => new Projection({ code: code || 'project', units: 'm' });

const shapes = {
  AL: { points: 3, radius: 6 },
  IL: { points: 4, radius: 6 },
  IAL: { points: 4, radius: 7, angle: Math.PI / 4 },
};

/** Plan of the surveyed line; a click jumps there. */
export class Plan {
  readonly element = element('section', { class: 'plan', 'aria-label': 'Plan of the line' });
  private readonly map: OlMap;
  private readonly cursor = new Feature<Point>();
  private readonly window = new Feature<MultiLineString>();
  private readonly lines: VectorSource = new VectorSource();
  private next: () => void = () => {};
  private waiting = 0;

  constructor(
    private readonly survey: Survey,
    crs: string,
    background: string | undefined,
    go: (x: number) => void,
  ) {
    // A PROJ string is too long for a heading; an authority's code says all.
    this.element.append(element('h2', { title: crs }, `Plan · ${/^[A-Z]+:\d+$/.test(crs) ? crs : 'project map'}`));
    const target = element('div', { class: 'plan-map' });
    this.element.append(target);
    const projection = mapMetres(crs);
    this.map = new OlMap({
      target,
      layers: [...backgroundLayer(background, projection), new VectorLayer({ source: this.lines })],
      controls: [new ScaleLine({ units: 'metric', minWidth: 60 })],
      interactions: interactions({ keyboard: false }),
      view: new OlView({ projection, center: [0, 0], resolution: 1, constrainResolution: false }),
    });
    this.map.on('singleclick', (event) => {
      const x = this.nearest(event.coordinate[0], event.coordinate[1]);
      if (x !== null) go(x);
    });
    this.style();
  }

  /** Makes the features anew, with the theme's colours. */
  style(): void {
    this.lines.clear();
    const extent = [Infinity, Infinity, -Infinity, -Infinity];
    for (const line of this.survey.plan) {
      const feature = new Feature(new LineString(line.easting.map((e, i) => [e, line.northing[i]])));
      feature.setStyle(new Style({ stroke: new Stroke({ color: css('--muted'), width: 2 }) }));
      this.lines.addFeature(feature);
      extend(extent, feature.getGeometry()!.getExtent());
    }
    for (const [kind, fill, radius] of [['fixes', '--fix', 1.5], ['landmarks', '--cursor', 3]] as const) {
      const places = this.survey.recorded?.[kind];
      const at = (places?.easting ?? []).flatMap((e, i) => (e === null || places!.northing[i] === null ? [] : [[e, places!.northing[i]!]]));
      if (at.length === 0) continue;
      const feature = new Feature(new MultiPoint(at));
      feature.setStyle(new Style({ image: new Circle({ radius, fill: new Fill({ color: css(fill) }) }) }));
      this.lines.addFeature(feature);
      extend(extent, feature.getGeometry()!.getExtent());
    }
    this.window.setStyle(new Style({ stroke: new Stroke({ color: css('--line'), width: 4 }) }));
    this.lines.addFeature(this.window);
    for (const c of this.survey.controlPoints) this.add(c.x, new RegularShape({ points: 4, radius: 2.5, fill: new Fill({ color: css('--muted') }) }));
    for (const e of this.survey.exceedances) this.add(e.peakAt, new RegularShape({ ...shapes[e.class], fill: new Fill({ color: css(limitStyle[e.class].color) }) }));
    this.cursor.setStyle(new Style({ image: new Circle({ radius: 7, stroke: new Stroke({ color: css('--cursor'), width: 2 }) }) }));
    this.lines.addFeature(this.cursor);
    if (Number.isFinite(extent[0])) requestAnimationFrame(() => {
      this.map.updateSize();
      this.map.getView().fit(extent, { padding: [18, 18, 26, 18], maxZoom: 30 });
    });
  }

  /** The map follows ten times a second: it is a matter of where, not of how fast. */
  show(from: number, to: number, cursor: number): void {
    this.next = () => this.move(from, to, cursor);
    if (this.waiting !== 0) return;
    this.next();
    this.waiting = window.setTimeout(() => {
      this.waiting = 0;
      this.next();
    }, 100);
  }

  private move(from: number, to: number, cursor: number): void {
    const at = this.place(cursor);
    if (at) this.cursor.setGeometry(new Point(at));
    const parts = this.survey.plan.map((line) => {
      const [a, b] = [lowerBound(line.x, from), lowerBound(line.x, to)];
      return [this.on(line, from), ...line.easting.slice(a, b).map((e, i) => [e, line.northing[a + i]]), this.on(line, to)].filter((p) => p !== null);
    });
    this.window.setGeometry(new MultiLineString(parts.filter((p) => p.length > 1)));
  }

  private add(x: number, image: RegularShape): void {
    const at = this.place(x);
    if (!at) return;
    const feature = new Feature(new Point(at));
    feature.setStyle(new Style({ image }));
    this.lines.addFeature(feature);
  }

  dispose(): void {
    clearTimeout(this.waiting);
    this.map.setTarget(undefined);
    this.map.dispose();
  }

  private place(x: number): number[] | null {
    for (const line of this.survey.plan) {
      const at = this.on(line, x);
      if (at) return at;
    }
    return null;
  }

  /** The point of a polyline at a place; null outside it. */
  private on(line: Polyline, x: number): number[] | null {
    const i = lowerBound(line.x, x);
    if (i >= line.x.length) return null;
    if (i === 0) return x < line.x[0] - 1 ? null : [line.easting[0], line.northing[0]];
    const f = (x - line.x[i - 1]) / (line.x[i] - line.x[i - 1]);
    return [line.easting[i - 1] + f * (line.easting[i] - line.easting[i - 1]), line.northing[i - 1] + f * (line.northing[i] - line.northing[i - 1])];
  }

  private nearest(easting: number, northing: number): number | null {
    let best = Infinity;
    let x: number | null = null;
    for (const line of this.survey.plan) {
      line.easting.forEach((e, i) => {
        const d = Math.hypot(e - easting, line.northing[i] - northing);
        if (d < best) [best, x] = [d, line.x[i]];
      });
    }
    return x;
  }
}
