// SPDX-License-Identifier: Apache-2.0
// A GeoTIFF of one colour, written from its specification alone: no other program is needed to test a background.
import { writeFileSync } from 'node:fs';

/** width x height pixels of `metre`, the upper left corner at (easting, northing) of a projected CRS. */
export function writeGeoTiff(file, { epsg, easting, northing, metre, width = 64, height = 64, color = [200, 30, 30] }) {
  const pixels = Buffer.alloc(3 * width * height, Buffer.from(color));
  const entries = [];
  const extra = [];
  const tags = 14;
  let free = 8 + 2 + 12 * tags + 4;
  const put = (tag, type, values) => {
    const size = { 3: 2, 4: 4, 12: 8 }[type];
    const data = Buffer.alloc(Math.max(4, size * values.length));
    values.forEach((v, i) => (type === 3 ? data.writeUInt16LE(v, 2 * i) : type === 4 ? data.writeUInt32LE(v, 4 * i) : data.writeDoubleLE(v, 8 * i)));
    const entry = Buffer.alloc(12);
    entry.writeUInt16LE(tag, 0);
    entry.writeUInt16LE(type, 2);
    entry.writeUInt32LE(values.length, 4);
    if (data.length <= 4) data.copy(entry, 8);
    else {
      entry.writeUInt32LE(free, 8);
      extra.push(data);
      free += data.length;
    }
    entries.push(entry);
    return entry;
  };
  put(256, 4, [width]);
  put(257, 4, [height]);
  put(258, 3, [8, 8, 8]);
  put(259, 3, [1]); // not compressed
  put(262, 3, [2]); // RGB
  const offset = put(273, 4, [0]);
  put(277, 3, [3]);
  put(278, 4, [height]);
  put(279, 4, [pixels.length]);
  put(284, 3, [1]);
  put(33550, 12, [metre, metre, 0]);
  put(33922, 12, [0, 0, 0, easting, northing, 0]);
  put(34735, 3, [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, epsg]);
  put(339, 3, [1, 1, 1]);
  entries.sort((a, b) => a.readUInt16LE(0) - b.readUInt16LE(0));
  offset.writeUInt32LE(free, 8);
  const head = Buffer.alloc(10);
  head.write('II*\0', 'latin1');
  head.writeUInt32LE(8, 4);
  head.writeUInt16LE(tags, 8);
  writeFileSync(file, Buffer.concat([head, ...entries, Buffer.alloc(4), ...extra, pixels]));
  return file;
}
