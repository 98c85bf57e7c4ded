// SPDX-License-Identifier: Apache-2.0

/** One kind of result on the page. A result that is replaced gets a new screen; the address keeps the view. */
export interface Screen {
  start(): Promise<void>;
  /** Takes away every listener and drawing that outlives its elements. */
  dispose(): void;
}
