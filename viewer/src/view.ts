// SPDX-License-Identifier: Apache-2.0

/** What part of the line is seen and where the cursor is; the address's fragment holds it, so a link shows the same. */
export class View {
  from: number;
  to: number;
  cursor: number;
  private readonly listeners: (() => void)[] = [];
  private writing = 0;

  constructor(
    readonly first: number,
    readonly last: number,
    signal: AbortSignal,
  ) {
    this.from = first;
    this.to = last;
    this.cursor = (first + last) / 2;
    this.readHash();
    addEventListener('hashchange', () => this.readHash() && this.emit(false), { signal });
    signal.addEventListener('abort', () => clearTimeout(this.writing));
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Shows [from, to], kept inside the line and at least 2 m (or the whole line, if shorter) wide. */
  zoom(from: number, to: number): void {
    const width = Math.min(Math.max(to - from, 2), this.last - this.first);
    const centre = (from + to) / 2;
    const a = Math.min(Math.max(centre - width / 2, this.first), this.last - width);
    [this.from, this.to] = [a, a + width];
    this.emit(true);
  }

  moveCursor(x: number): void {
    this.cursor = Math.min(Math.max(x, this.first), this.last);
    if (this.cursor < this.from || this.cursor > this.to) {
      const half = (this.to - this.from) / 2;
      this.zoom(this.cursor - half, this.cursor + half);
      return;
    }
    this.emit(true);
  }

  /** Shows a place with some of its surroundings. */
  goTo(x: number, width = Math.min(this.to - this.from, 400)): void {
    this.cursor = Math.min(Math.max(x, this.first), this.last);
    this.zoom(x - width / 2, x + width / 2);
  }

  fit(): void {
    this.zoom(this.first, this.last);
  }

  private emit(write: boolean): void {
    if (write) this.writeHash();
    for (const listener of this.listeners) listener();
  }

  /** The address follows a tenth of a second behind: it costs more than a frame of drawing. */
  private writeHash(): void {
    if (this.writing !== 0) return;
    this.writing = window.setTimeout(() => {
      this.writing = 0;
      history.replaceState(null, '', `#from=${this.from.toFixed(2)}&to=${this.to.toFixed(2)}&at=${this.cursor.toFixed(2)}`);
    }, 100);
  }

  private readHash(): boolean {
    const query = new URLSearchParams(location.hash.slice(1));
    const [from, to, at] = ['from', 'to', 'at'].map((k) => Number(query.get(k) ?? NaN));
    if (!(to > from)) return false;
    this.from = Math.max(from, this.first);
    this.to = Math.min(to, this.last);
    if (!(this.to > this.from)) [this.from, this.to] = [this.first, this.last];
    if (Number.isFinite(at)) this.cursor = Math.min(Math.max(at, this.first), this.last);
    return true;
  }
}
