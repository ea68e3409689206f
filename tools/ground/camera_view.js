// The camera's picture with regions and points.
import { byId, text } from "./dom.js";
import { drawMark, fitted, plain } from "./plot.js";

const kRegionStyles = {
  measuring: { colour: "#56b4e9", dash: [] },
  searching: { colour: "#ffb000", dash: [8, 5] },
  lost: { colour: "#ff7043", dash: [2, 5] },
};

export class CameraView {
  constructor() {
    this.canvas = byId("camera");
    this.image = new Image();
    this.image.decoding = "async";
    this.image.addEventListener("load", () => { this.shown = this.asked; this.wanted(); });
    this.asked = this.shown = null;
    this.wanted = () => {};
  }
  // Pictures are asked for one at a time.
  load(preview) {
    if (!preview.has_jpeg || this.asked === preview.n) return;
    if (this.asked !== this.shown && !this.image.complete) return;
    this.asked = preview.n;
    this.image.src = "preview.jpg?n=" + preview.n;
  }
  draw(state) {
    const p = state.preview, health = state.health;
    if (!p) return;
    const [w, h] = p.image;
    if (!(w > 0 && h > 0)) return;
    this.canvas.style.aspectRatio = w + "/" + h;
    const width = this.canvas.clientWidth, c = fitted(this.canvas, width, width * h / w), s = width / w;
    if (this.shown !== null && this.image.naturalWidth) c.drawImage(this.image, 0, 0, p.size[0] * p.scale * s, p.size[1] * p.scale * s);
    c.lineWidth = 3;
    c.font = "600 15px system-ui,sans-serif";
    p.regions.forEach((region, r) => this.region(c, s, region, health && health.regions[r]));
    for (let i = 0; i < p.points.u.length; ++i) {
      if (p.points.u[i] === null) continue;
      const x = (p.points.u[i] + 0.5) * s, y = (p.points.v[i] + 0.5) * s;
      if (p.points.inlier[i]) {
        c.fillStyle = "#000";
        c.fillRect(x - 2.5, y - 2.5, 5, 5);
        c.fillStyle = "#f0e442";
        c.fillRect(x - 1.5, y - 1.5, 3, 3);
      } else {
        drawMark(c, x, y, "cross", "#d55e00", 4);
      }
    }
    const seen = p.points.u.filter((u) => u !== null).length, good = p.points.inlier.filter((q) => q).length;
    text(byId("camera-note"), "Frame " + p.frame + " at " + plain(p.t_s) + " s. Yellow squares: " + good + " points that agree; orange crosses: " +
      (seen - good) + " that do not; " + (p.points.u.length - seen) + " not seen.");
    this.canvas.setAttribute("aria-label", "Camera picture with " + p.regions.length + " regions and " + seen + " points");
  }
  region(c, s, region, status) {
    const state = status ? status.state : "measuring", style = kRegionStyles[state] || kRegionStyles.lost;
    const [u, v, w, h] = region.rect.map((x) => x * s);
    c.setLineDash([]);
    c.strokeStyle = "rgba(0,0,0,.7)";
    c.lineWidth = 5;
    c.strokeRect(u, v, w, h);
    c.strokeStyle = style.colour;
    c.lineWidth = 2.5;
    c.setLineDash(style.dash);
    c.strokeRect(u, v, w, h);
    c.setLineDash([]);
    const name = (status ? status.name : "") + (state === "measuring" ? "" : ": " + state);
    if (!name) return;
    const wide = c.measureText(name).width + 10, isFlat = h < 30 && u + w + 4 + wide < c.canvas.clientWidth;  // beside a flat one: its neighbours are near
    const x = isFlat ? u + w + 4 : Math.max(0, Math.min(u, c.canvas.clientWidth - wide)), y = isFlat ? v + h / 2 - 10 : v > 22 ? v - 22 : v + h;
    c.fillStyle = "rgba(0,0,0,.75)";
    c.fillRect(x, y, wide, 21);
    c.fillStyle = style.colour;
    c.textAlign = "left";
    c.fillText(name, x + 5, y + 16);
  }
}
