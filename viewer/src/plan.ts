// SPDX-License-Identifier: Apache-2.0
import 'ol/ol.css';
import Feature from 'ol/Feature';
import OlMap from 'ol/Map';
import OlView from 'ol/View';
import { ScaleLine } from 'ol/control';
import LineString from 'ol/geom/LineString';
import Point from 'ol/geom/Point';
import VectorLayer from 'ol/layer/Vector';
import Projection from 'ol/proj/Projection';
import VectorSource from 'ol/source/Vector';
import { Fill, RegularShape, Circle, Stroke, Style } from 'ol/style';
import { lowerBound } from './pyramid';
import type { ControlPoint, Exceedance, Polyline } from './contract';
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
  private readonly window = new Feature<LineString>();
  private readonly lines: VectorSource = new VectorSource();

  constructor(
    private readonly axis: Polyline[],
    private readonly exceedances: Exceedance[],
    private readonly control: ControlPoint[],
    crs: string,
    go: (x: number) => void,
  ) {
    this.element.append(element('h2', {}, `Plan · ${crs}`));
    const target = element('div', { class: 'plan-map' });
    this.element.append(target);
    this.map = new OlMap({
      target,
      layers: [new VectorLayer({ source: this.lines })],
      controls: [new ScaleLine({ units: 'metric', minWidth: 60 })],
      view: new OlView({ projection: mapMetres(crs), center: [0, 0], resolution: 1, constrainResolution: false }),
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
    for (const line of this.axis) {
      const feature = new Feature(new LineString(line.easting.map((e, i) => [e, line.northing[i]])));
      feature.setStyle(new Style({ stroke: new Stroke({ color: css('--muted'), width: 2 }) }));
      this.lines.addFeature(feature);
      const e = feature.getGeometry()!.getExtent();
      for (const i of [0, 1]) extent[i] = Math.min(extent[i], e[i]);
      for (const i of [2, 3]) extent[i] = Math.max(extent[i], e[i]);
    }
    this.window.setStyle(new Style({ stroke: new Stroke({ color: css('--line'), width: 4 }) }));
    this.lines.addFeature(this.window);
    for (const e of this.exceedances) this.add(e.peakAt, new RegularShape({ ...shapes[e.class], fill: new Fill({ color: css(limitStyle[e.class].color) }) }));
    for (const c of this.control) this.add(c.x, new RegularShape({ points: 4, radius: 5, radius2: 0, stroke: new Stroke({ color: css('--text'), width: 1 }) }));
    this.cursor.setStyle(new Style({ image: new Circle({ radius: 7, stroke: new Stroke({ color: css('--cursor'), width: 2 }) }) }));
    this.lines.addFeature(this.cursor);
    if (Number.isFinite(extent[0])) requestAnimationFrame(() => {
      this.map.updateSize();
      this.map.getView().fit(extent, { padding: [18, 18, 26, 18], maxZoom: 30 });
    });
  }

  show(from: number, to: number, cursor: number): void {
    const at = this.place(cursor);
    if (at) this.cursor.setGeometry(new Point(at));
    const line = this.axis[0];
    if (!line) return;
    const x = Float64Array.from(line.x);
    const [a, b] = [lowerBound(x, from), lowerBound(x, to)];
    const points = [this.place(from), ...line.easting.slice(a, b).map((e, i) => [e, line.northing[a + i]]), this.place(to)];
    this.window.setGeometry(new LineString(points.filter((p): p is number[] => p !== null)));
  }

  private add(x: number, image: RegularShape): void {
    const at = this.place(x);
    if (!at) return;
    const feature = new Feature(new Point(at));
    feature.setStyle(new Style({ image }));
    this.lines.addFeature(feature);
  }

  private place(x: number): number[] | null {
    for (const line of this.axis) {
      const i = lowerBound(Float64Array.from(line.x), x);
      if (i === 0 && x < line.x[0] - 1) continue;
      if (i >= line.x.length) continue;
      if (i === 0) return [line.easting[0], line.northing[0]];
      const f = (x - line.x[i - 1]) / (line.x[i] - line.x[i - 1]);
      return [line.easting[i - 1] + f * (line.easting[i] - line.easting[i - 1]), line.northing[i - 1] + f * (line.northing[i] - line.northing[i - 1])];
    }
    return null;
  }

  private nearest(easting: number, northing: number): number | null {
    let best = Infinity;
    let x: number | null = null;
    for (const line of this.axis) {
      line.easting.forEach((e, i) => {
        const d = Math.hypot(e - easting, line.northing[i] - northing);
        if (d < best) [best, x] = [d, line.x[i]];
      });
    }
    return x;
  }
}
