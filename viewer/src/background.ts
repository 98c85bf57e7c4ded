// SPDX-License-Identifier: Apache-2.0
import type Projection from 'ol/proj/Projection';
import ImageLayer from 'ol/layer/Image';
import ImageSource from 'ol/source/Image';
import { getBackground } from './api';

const most = 4096; // px each way

/** The picture of the ground that `versine view --background` was given, resampled by the program into the map's metres. */
export function backgroundLayer(name: string | undefined, projection: Projection): ImageLayer<ImageSource>[] {
  if (!name) return [];
  const loader = async (extent: number[], resolution: number, ratio: number) => {
    const pixels = (length: number) => Math.min(Math.max(Math.round((length / resolution) * ratio), 1), most);
    const image = await getBackground(extent, pixels(extent[2] - extent[0]), pixels(extent[3] - extent[1]));
    document.documentElement.dataset.background = image ? 'shown' : 'none here';
    return { image: image ?? new OffscreenCanvas(1, 1).transferToImageBitmap(), extent, resolution };
  };
  return [new ImageLayer({ source: new ImageSource({ projection, loader, attributions: name }), opacity: 0.6 })];
}
