// The drop as it moves: journal, ring, balls, cage and forces, drawn on canvases.
(() => {
  "use strict";
  const SIZE = 420; // px
  const TURN = 2 * Math.PI;

  const element = (tag, parent, text = "") => {
    const made = parent.appendChild(document.createElement(tag));
    made.textContent = text;
    return made;
  };
  const probe = document.body.appendChild(document.createElement("span"));
  probe.hidden = true;
  const paint = (word) => {
    probe.style.color = `var(--${word})`;
    return getComputedStyle(probe).color;
  };

  const draw = (canvas, data, k) => {
    const sharp = window.devicePixelRatio || 1;
    if (canvas.width !== SIZE * sharp) canvas.width = canvas.height = SIZE * sharp;
    const pen = canvas.getContext("2d");
    const reach = data.pitch ? 1.22 * (data.pitch + data.ball) : 1.45 * data.bore;
    const scale = (0.5 * SIZE * sharp) / reach;
    pen.setTransform(scale, 0, 0, -scale, 0.5 * SIZE * sharp, 0.5 * SIZE * sharp);
    pen.clearRect(-reach, -reach, 2 * reach, 2 * reach);
    const thin = 1.2 / scale * sharp;
    const circle = (x, y, radius, stroke, fill, width = 1) => {
      pen.beginPath();
      pen.arc(x, y, radius, 0, TURN);
      if (fill) { pen.fillStyle = paint(fill); pen.fill(); }
      if (stroke) { pen.strokeStyle = paint(stroke); pen.lineWidth = width * thin; pen.stroke(); }
    };
    const mark = (x, y, angle, from, to, word, width) => {
      pen.beginPath();
      pen.moveTo(x + from * Math.cos(angle), y + from * Math.sin(angle));
      pen.lineTo(x + to * Math.cos(angle), y + to * Math.sin(angle));
      pen.strokeStyle = paint(word);
      pen.lineWidth = width * thin;
      pen.stroke();
    };
    const [jx, jy, ja] = data.journal[k];
    const [rx, ry, ra] = data.ring[k];
    if (data.pitch) {
      circle(0, 0, data.pitch + 1.35 * data.ball, "edge", "core");
      circle(0, 0, data.pitch + 0.8 * data.ball, "edge", "paper");
      circle(rx, ry, data.pitch - 0.8 * data.ball, "edge", "core");
      circle(rx, ry, data.bore, "edge", "paper");
      mark(rx, ry, ra, data.bore, data.pitch - 0.8 * data.ball, "blue", 3);
      const turned = data.balls[k][0];
      if (data.caged) circle(0, 0, data.pitch, "purple", null, 2.5);
      for (let b = 0; b < data.count; b += 1) {
        const angle = turned + (b * TURN) / data.count;
        const at = [data.pitch * Math.cos(angle), data.pitch * Math.sin(angle)];
        circle(...at, data.ball, b ? "edge" : "blue", "raised", b ? 1 : 2);
      }
    } else {
      circle(0, 0, 1.22 * data.bore, "edge", "sleeve");
      circle(0, 0, data.bore, "edge", "paper");
    }
    circle(jx, jy, 1, "orange", "raised", 2);
    mark(jx, jy, ja, 0, 1, "orange", 2);
    const [fx, fy] = data.force[k];
    const size = Math.hypot(fx, fy);
    if (size > 0.004) arrow(pen, [jx - fx / size, jy - fy / size], [fx / size, fy / size], 0.12 + data.push * size, thin);
  };

  // The bearing from the side: what stands at (y, z) in a body goes with its displacement and tilt.
  const drawSide = (canvas, data, k) => {
    const side = data.side;
    const sharp = window.devicePixelRatio || 1;
    if (canvas.width !== SIZE * sharp) canvas.width = canvas.height = SIZE * sharp;
    const pen = canvas.getContext("2d");
    const reach = 1.04 * Math.max(...side.reach);
    const scale = (0.5 * SIZE * sharp) / reach;
    pen.setTransform(scale, 0, 0, -scale, 0.5 * SIZE * sharp, 0.5 * SIZE * sharp);
    pen.clearRect(-reach, -reach, 2 * reach, 2 * reach);
    const thin = 1.2 / scale * sharp;
    const [across, along] = side.magnified;
    const moved = ([y, z], [dy, dz, tilt]) => {
      const at = [y + dy - across * tilt * z, z + dz + along * tilt * y];
      return side.upright ? at : at.reverse();
    };
    const outline = (corners, motion, stroke, fill, width) => {
      pen.beginPath();
      corners.forEach((corner) => pen.lineTo(...moved(corner, motion)));
      pen.closePath();
      pen.fillStyle = paint(fill);
      pen.fill();
      pen.strokeStyle = paint(stroke);
      pen.lineWidth = width * thin;
      pen.stroke();
    };
    const rotor = side.moves[k];
    const ring = side.rings[k];
    side.outer.forEach((corners) => outline(corners, [0, 0, 0], "edge", side.ball ? "core" : "sleeve", 1));
    side.ring.forEach((corners) => outline(corners, ring, "edge", "core", 1));
    for (const ball of side.balls) {
      pen.beginPath();
      pen.arc(...moved(ball, ring.map((v) => 0.5 * v)), side.ball, 0, TURN);
      pen.fillStyle = paint("raised");
      pen.fill();
      pen.strokeStyle = paint("edge");
      pen.lineWidth = thin;
      pen.stroke();
    }
    outline(side.rotor, rotor, "orange", "raised", 2);
    const push = side.force[k];
    if (Math.abs(push) > 0.004) {
      const to = side.upright ? [0, Math.sign(push)] : [Math.sign(push), 0];
      arrow(pen, moved([0, 0], rotor), to, side.push * Math.abs(push), thin);
    }
  };

  const arrow = (pen, [x, y], [nx, ny], length, thin) => {
    const tip = [x + length * nx, y + length * ny];
    const head = Math.min(0.16, 0.5 * length);
    pen.strokeStyle = pen.fillStyle = paint("alarm");
    pen.lineWidth = 3 * thin;
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(tip[0] - head * nx, tip[1] - head * ny);
    pen.stroke();
    pen.beginPath();
    pen.moveTo(...tip);
    pen.lineTo(tip[0] - head * nx + 0.5 * head * ny, tip[1] - head * ny - 0.5 * head * nx);
    pen.lineTo(tip[0] - head * nx - 0.5 * head * ny, tip[1] - head * ny + 0.5 * head * nx);
    pen.fill();
  };

  const build = (figure) => {
    const seats = JSON.parse(figure.querySelector("script").textContent);
    const stage = figure.querySelector(".stage");
    const count = seats[0].time.length;
    figure.querySelector(".noscript").remove();
    stage.hidden = false;
    const row = element("div", stage);
    row.className = "seats";
    const drawn = seats.map((data) => {
      const holder = element("div", row);
      element("h3", holder, data.title);
      const canvas = element("canvas", holder);
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", `Journal, ring and balls of ${data.title} as they move`);
      const one = { data, canvas, told: element("p", holder) };
      if (data.side) {
        const beside = element("div", row);
        element("h3", beside, `${data.title}, from the side`);
        one.side = element("canvas", beside);
        one.side.setAttribute("role", "img");
        one.side.setAttribute("aria-label", `Rotor and ring of ${data.title} along the shaft as they move`);
        one.sideTold = element("p", beside);
      }
      return one;
    });
    const tools = element("div", stage);
    tools.className = "tools";
    const play = element("button", tools, "Play");
    play.type = "button";
    const slider = element("input", tools);
    Object.assign(slider, { type: "range", min: 0, max: count - 1, value: 0 });
    slider.setAttribute("aria-label", "Moment of the drop");
    const clock = element("output", tools);

    let at = 0;
    let begun = null;
    const show = (k) => {
      at = Math.max(0, Math.min(count - 1, k));
      slider.value = at;
      const { time, slower } = seats[0];
      clock.textContent = `${time[at].toFixed(2)} ms after the shutdown, ${Math.round(slower[at])} times slower`;
      slider.setAttribute("aria-valuetext", clock.textContent);
      for (const { data, canvas, told, side, sideTold } of drawn) {
        draw(canvas, data, at);
        if (side) {
          drawSide(side, data, at);
          const um = (motion) => ((1e6 * data.side.unit) / data.side.magnified[1]) * motion[1];
          sideTold.textContent = `along the shaft: rotor ${um(data.side.moves[at]).toFixed(0)} µm` + (data.side.ball ? `, ring ${um(data.side.rings[at]).toFixed(1)} µm` : "") + `, force ${(data.side.largest * Math.abs(data.side.force[at])).toFixed(0)} N`;
        }
        const force = data.largest * Math.hypot(...data.force[at]);
        const stage = data.stages.findLast(([since]) => since <= time[at]);
        told.textContent = `rotor ${data.rpm[at][0]} rpm` + (data.pitch ? `, ring ${data.rpm[at][1]} rpm` : "") + `, force ${force.toFixed(0)} N` + (stage ? `, ${stage[1]}` : "");
      }
    };
    const step = (now) => {
      if (begun === null) return;
      const k = begun.from + Math.floor(((now - begun.when) * seats[0].rate) / 1000);
      show(k);
      if (k >= count - 1) stop(); else requestAnimationFrame(step);
    };
    const stop = () => { begun = null; play.textContent = "Play"; };
    play.addEventListener("click", () => {
      if (begun !== null) { stop(); return; }
      begun = { when: performance.now(), from: at >= count - 1 ? 0 : at };
      play.textContent = "Pause";
      requestAnimationFrame(step);
    });
    slider.addEventListener("input", () => { stop(); show(Number(slider.value)); });
    window.addEventListener("repaint", () => show(at));
    const presses = (k) => seats.some(({ force, side }) => Math.hypot(...force[k]) > 0.3 || Math.abs(side ? side.force[k] : 0) > 0.3);
    const first = seats[0].time.findIndex((_, k) => presses(k));
    show(Math.max(0, first));
  };

  document.querySelectorAll("figure.motion").forEach(build);
})();
