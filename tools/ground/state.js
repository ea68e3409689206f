// What the page knows: the newest of everything, and histories of fixed length. No document here: a test feeds it.

export const kTraceLength = 2048;     // samples of each channel
export const kMostChannels = 32;
export const kMostEstimates = 240;    // of a longer flight every second older one is left out, again and again
const kFields = 5;                    // hz, hz_std, damping, damping_std, id

export class State {
  constructor() {
    this.boot = null;
    this.run = null;
    this.version = 0;  // grows with everything applied
    this.clear();
  }
  clear() {
    this.link = null;
    this.health = this.modes = this.spectra = this.preview = this.closure = this.structure = null;
    this.estimates = [];
    this.clearTraces();
  }
  clearTraces() {
    this.traces = { names: [], rings: [], time: new Float64Array(kTraceLength), n: 0, next: 0, stride: 1 };
  }

  // One snapshot, whole or in part. Returns the names of what changed; "run" where the service began again.
  apply(data) {
    const changed = new Set(["link"]);
    const link = data.link;
    if (this.boot !== null && link.boot === this.boot && this.run !== null && link.run !== this.run) {
      this.clear();
      changed.add("run");
    }
    if (link.boot !== this.boot) this.clearTraces();
    this.boot = link.boot, this.run = link.run, this.link = link;
    for (const part of ["health", "modes", "spectra", "preview", "closure", "structure"]) {
      if (!data[part]) continue;
      this[part] = data[part];
      changed.add(part);
    }
    if (data.modes) this.addEstimate(data.modes);
    if (data.traces && this.addTraces(data.traces)) changed.add("traces");
    ++this.version;
    return changed;
  }

  addEstimate(modes) {
    const last = this.estimates.length ? this.estimates[this.estimates.length - 1] : null;
    if (last && modes.number === last.number) return;
    if (last && modes.number < last.number) this.estimates = [];
    const values = new Float32Array(modes.modes.length * kFields), verdicts = [];
    modes.modes.forEach((m, i) => {
      const known = (v) => (v === null || v === undefined ? NaN : v);
      values.set([known(m.hz), known(m.hz_std), known(m.damping), known(m.damping_std), m.id], i * kFields);
      verdicts.push(m.verdict);
    });
    this.estimates.push({ number: modes.number, duration_s: modes.duration_s, values, verdicts });
    if (this.estimates.length <= kMostEstimates) return;
    const half = this.estimates.length >> 1;
    this.estimates = this.estimates.filter((_, i) => i >= half || i % 2 === 0);
  }

  // Every estimate of one mode: {t_s, hz, hz_std, damping, damping_std}.
  historyOf(id) {
    const out = [];
    for (const estimate of this.estimates) {
      const v = estimate.values;
      for (let i = 0; i < v.length; i += kFields) {
        if (v[i + 4] !== id || id === 0) continue;
        out.push({ t_s: estimate.duration_s, hz: v[i], hz_std: v[i + 1], damping: v[i + 2], damping_std: v[i + 3] });
        break;
      }
    }
    return out;
  }
  forEachPole(estimate, call) {
    const v = estimate.values;
    for (let i = 0; i < v.length; i += kFields) call(v[i], estimate.verdicts[i / kFields]);
  }

  addTraces(part) {
    let t = this.traces;
    const names = part.channels.slice(0, kMostChannels);
    if (names.join("\n") !== t.names.join("\n") || part.stride !== t.stride) {
      this.clearTraces();
      t = this.traces;
      t.names = names;
      t.stride = part.stride;
      t.rings = names.map(() => new Float32Array(kTraceLength).fill(NaN));
    }
    let isNew = false;
    for (let i = 0; i < part.t_s.length; ++i) {
      const number = part.first + i * part.stride;
      if (number < t.next) continue;
      if (t.n > 0 && number > t.next + t.stride - 1) this.push(t, part.t_s[i], () => NaN);  // some are missing: a gap
      this.push(t, part.t_s[i], (c) => part.mm[c][i]);
      t.next = number + 1;
      isNew = true;
    }
    return isNew;
  }
  push(t, time, value) {
    const at = t.n % kTraceLength;
    t.time[at] = time;
    for (let c = 0; c < t.rings.length; ++c) {
      const v = value(c);
      t.rings[c][at] = v === null || v === undefined ? NaN : v;
    }
    ++t.n;
  }
}

// ---- Words.
export function duration(s) {
  if (!Number.isFinite(s)) return "?";
  if (s < 90) return Math.max(1, Math.round(s)) + " s";
  if (s < 5400) return Math.round(s / 60) + " minutes";
  return (s / 3600).toFixed(1) + " hours";
}

// A standard deviation falls with the root of the record: for a share p of itself it takes (s / p)^2 of the record.
export function recordWanted(record_s, share, wanted) {
  return Math.max(0, record_s * (share * share / (wanted * wanted) - 1));
}

export function hoverAdvice(mode, record_s) {
  const share = mode.damping_std / mode.damping;
  if (!(mode.damping > 0) || mode.damping_std === null || !Number.isFinite(share)) return "Damping not known well enough to say how much longer";
  const now = "Damping known to " + Number((100 * share).toPrecision(2)) + " %";
  const asked = (p) => recordWanted(record_s, share, p / 100);
  const for10 = mode.more_s === null || mode.more_s === undefined ? asked(10) : mode.more_s;
  const for5 = for10 > 0 ? 4 * (record_s + for10) - record_s : asked(5);
  if (for5 <= 0) return now + ": enough";
  if (for10 <= 0) return now + ": hover " + duration(for5) + " more for 5 %";
  return now + ": hover " + duration(for10) + " more for 10 %, " + duration(for5) + " for 5 %";
}
