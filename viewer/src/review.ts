// SPDX-License-Identifier: Apache-2.0
import { getConstraints, putConstraints } from './api';
import type { Constraint, Journey, Stretch } from './contract';

const margin = 0.5; // s: a stretch begins and ends on tracks that both paths share

/** Tracks of a path between two distances on path 1; other paths are asked by time, which they share. */
export function chooseStretch(journey: Journey, stretch: Stretch, tracks: string[], comment: string): Constraint {
  return { recording: journey.recording, from_s: stretch.from - margin, to_s: stretch.to + margin, tracks: [...neighbours(journey, stretch), ...tracks], excluded: false, comment };
}

/** The whole journey on one path. */
export function choosePath(journey: Journey, path: number, comment: string): Constraint {
  const hypothesis = journey.hypotheses.find((h) => h.path === path)!;
  return { recording: journey.recording, from_s: journey.from, to_s: journey.to, tracks: hypothesis.tracks.map((t) => t.id), excluded: false, comment };
}

/** None of the tracks that path 1 has there alone. */
export function forbid(journey: Journey, stretch: Stretch, comment: string): Constraint {
  const other = new Set(stretch.alternative);
  return { recording: journey.recording, from_s: stretch.from, to_s: stretch.to, tracks: stretch.taken.filter((t) => !other.has(t)), excluded: true, comment };
}

/** Tracks of path 1 on either side of a stretch. */
function neighbours(journey: Journey, stretch: Stretch): string[] {
  const tracks = journey.hypotheses[0].tracks;
  const near = tracks.filter((t) => t.to >= stretch.fromM - 50 && t.from <= stretch.toM + 50);
  const inside = new Set(stretch.taken);
  return near.map((t) => t.id).filter((id) => !inside.has(id));
}

const same = (a: Constraint, b: Constraint) => a.recording === b.recording && a.from_s === b.from_s && a.to_s === b.to_s;

/** What was decided, kept in a file beside the result that the next run obeys. */
export class Review {
  private list: Constraint[] = [];
  private readonly history: Constraint[][] = [];

  async load(): Promise<void> {
    this.list = await getConstraints();
  }

  get constraints(): readonly Constraint[] {
    return this.list;
  }

  /** A later decision about the same span replaces the earlier one. */
  async confirm(constraint: Constraint): Promise<void> {
    await this.write([...this.list.filter((c) => !same(c, constraint)), constraint]);
  }

  async remove(index: number): Promise<void> {
    await this.write(this.list.filter((_, i) => i !== index));
  }

  /** Takes back the last decision of this session; false when there is none. */
  async undo(): Promise<boolean> {
    const before = this.history.pop();
    if (!before) return false;
    await putConstraints(before);
    this.list = before;
    return true;
  }

  decided(journey: Journey, stretch: Stretch): Constraint | undefined {
    return this.list.find((c) => (!c.recording || c.recording === journey.recording) && c.from_s <= stretch.from && c.to_s >= stretch.to);
  }

  private async write(next: Constraint[]): Promise<void> {
    await putConstraints(next);
    this.history.push(this.list);
    this.list = next;
  }
}
