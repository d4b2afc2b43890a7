"use strict";
// The robot at one tick: its outline, twice the claimed deviation around the estimate, and the way
// that the commands in flight will take it. Part of the report and of the live page.

const page = JSON.parse(document.getElementById("page").textContent);
const EDGES = 48;
const LONGEST_FLIGHT = 4096; // rows

function source(name, run) {
  return Bokeh.documents[0].get_model_by_name(`${name}-${run}`);
}

function whenDrawn(start) {
  const ready = window.Bokeh && Bokeh.documents.length && source("now", page.runs.length - 1);
  if (!ready) return setTimeout(whenDrawn, 20, start);
  start();
  document.documentElement.dataset.ready = "yes";
}

/** The last row that is not later than `time`. */
function rowAt(times, time) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle; else high = middle - 1;
  }
  return low;
}

/** An arrow whose rear corners are the wheels. */
function outline(x, y, theta, track) {
  const [c, s, half] = [Math.cos(theta), Math.sin(theta), track / 2];
  const corners = [[1.6 * half, 0], [0, half], [0.3 * half, 0], [0, -half]];
  return {
    x: corners.map(([forward, left]) => x + c * forward - s * left),
    y: corners.map(([forward, left]) => y + s * forward + c * left),
  };
}

/** Points whose distance is 2 by [[xx, xy], [xy, yy]], by its Cholesky factor. */
function ellipse(x, y, xx, xy, yy) {
  const a = Math.sqrt(xx), b = xy / a, c = Math.sqrt(Math.max(yy - b * b, 0));
  if (!(a > 0) || !Number.isFinite(b + c + x + y)) return {x: [], y: []};
  const points = {x: [], y: []};
  for (let edge = 0; edge < EDGES; edge++) {
    const angle = 2 * Math.PI * edge / EDGES;
    points.x.push(x + 2 * a * Math.cos(angle));
    points.y.push(y + 2 * (b * Math.cos(angle) + c * Math.sin(angle)));
  }
  return points;
}

/** Commands sent by the tick of `row` that come into force after it, by when they do. */
function inFlight(ticks, row, delay) {
  const now = ticks.tick[row], newest = ticks.tick[ticks.tick.length - 1];
  const flying = [];
  for (let each = row; each >= Math.max(0, row - LONGEST_FLIGHT); each--) {
    const stamp = ticks.tick[each], v = ticks.v_sent[each], omega = ticks.omega_sent[each];
    const known = Number.isFinite(ticks.due[each]);
    const due = known ? ticks.due[each] : stamp + delay > newest ? stamp + delay : NaN;
    if (due > now && Number.isFinite(v)) flying.push({due, v, omega});
  }
  return flying.sort((one, other) => one.due - other.due);
}

/** Where these lead from the pose, each in force until the next. */
function flightPath(pose, speeds, now, flying, Ts) {
  let [x, y, theta] = pose, {v, omega} = speeds, tick = now;
  const points = {x: [], y: []};
  for (const command of [...flying, {due: NaN}]) {
    points.x.push(x);
    points.y.push(y);
    const dt = ((Number.isFinite(command.due) ? command.due : tick + 1) - tick) * Ts;
    x += dt * v * Math.cos(theta + dt * omega / 2);
    y += dt * v * Math.sin(theta + dt * omega / 2);
    theta += dt * omega;
    tick = command.due;
    v = command.v;
    omega = command.omega;
  }
  points.x.push(x);
  points.y.push(y);
  return points;
}

function number(value, unit, digits = 2) {
  return Number.isFinite(value) ? `${value.toFixed(digits)} ${unit}` : `? ${unit}`;
}

/** Show the run as it was at this row of its ticks. */
function showRow(run, row) {
  const ticks = source("ticks", run).data, {track, sample_time, command_delay} = page.runs[run];
  const at = (name) => ticks[name][row];
  const pose = [at("x"), at("y"), at("theta")].some(Number.isNaN)
    ? [at("x_est"), at("y_est"), at("theta_est")] : [at("x"), at("y"), at("theta")];
  const speeds = {
    v: Number.isFinite(at("v")) ? at("v") : 0,
    omega: Number.isFinite(at("omega")) ? at("omega") : 0,
  };
  const flying = inFlight(ticks, row, command_delay);
  source("robot", run).data = outline(...pose, track);
  source("ellipse", run).data =
    ellipse(at("x_est"), at("y_est"), at("p_xx"), at("p_xy"), at("p_yy"));
  source("flight", run).data =
    flying.length ? flightPath(pose, speeds, at("tick"), flying, sample_time) : {x: [], y: []};
  document.getElementById(`readout-${run}`).textContent =
    `tick ${at("tick")}, ρ ${number(at("rho"), "m")}, v ${number(at("v"), "m/s")}, ` +
    `ω ${number(at("omega"), "rad/s")}; ` +
    (Number.isFinite(at("x_above"))
      ? `2σ claimed: x ${number(at("x_above"), "m", 3)}, y ${number(at("y_above"), "m", 3)}; ` : "") +
    `${flying.length} ${flying.length === 1 ? "command" : "commands"} in flight`;
}
