"use strict";
// Fills the plots as the run goes on, and passes the two orders on.

const MOST_ROWS = 6000;
const STOPPING = "stopping the robot";
const NUMBERS = /^(?!lane$|what$)/;
const state = document.getElementById("state");
const news = document.getElementById("news");
const notices = document.getElementById("notices");
let over = false;

/** Of each cause a mark at no time, which the legend shows; they are there before any other. */
let legend = null;

function after(first, more) {
  return Object.fromEntries(
    Object.entries(more).map(([name, column]) => [name, [...first[name], ...column]]));
}

/** JSON has no NaN. */
function numbers(cells) {
  const read = (name, cell) => (cell === null && NUMBERS.test(name) ? NaN : cell);
  return Object.fromEntries(
    Object.entries(cells).map(([name, column]) => [name, column.map((each) => read(name, each))]));
}

/** When each command that came was in force, beside the tick that it answers. */
function noteDue(ticks, commands) {
  commands.tick.forEach((stamp, each) => {
    const row = rowAt(ticks.tick, stamp);
    if (ticks.tick[row] === stamp) ticks.due[row] = commands.due[each];
  });
}

function take(tables, whole) {
  for (const [name, cells] of Object.entries(tables)) {
    const told = numbers(cells), held = source(name, 0);
    if (!held) continue;  // no plot of this page shows it
    if (whole) held.data = name === "marks" ? after(legend ??= held.data, told) : told;
    else if (Object.values(told)[0].length) held.stream(told, MOST_ROWS);
  }
  const ticks = source("ticks", 0).data;
  if (tables.commands && ticks.tick.length) noteDue(ticks, numbers(tables.commands));
  if (ticks.tick.length) showRow(0, ticks.tick.length - 1);
}

function say(texts, whole) {
  if (whole) notices.replaceChildren();
  for (const text of texts) {
    const line = document.createElement("li");
    line.textContent = text;
    notices.prepend(line);
  }
}

function tell(piece) {
  take(piece.tables, piece.whole);
  say(piece.texts, piece.whole);
  const times = source("ticks", 0).data.time;
  const running = times.length ? `running: ${times[times.length - 1].toFixed(2)} s` : "waiting for the run";
  over = over || piece.verdict !== null;
  if (piece.verdict !== null) state.textContent = piece.verdict;
  else if (!over) state.textContent = piece.stopped ? `${running}; the robot is stopped` : running;
  state.classList.toggle("bad", piece.stopped);
  if (over || (piece.stopped && news.textContent === STOPPING)) news.textContent = "";
  for (const button of document.querySelectorAll(".buttons button"))
    button.disabled = over || (button.id === "stop" && piece.stopped);
}

async function order(what, asked) {
  news.textContent = asked;
  try {
    const answer = await fetch(what + location.search, {method: "POST"});
    if (!answer.ok) news.textContent = `refused: ${answer.status} ${answer.statusText}`;
  } catch {
    news.textContent = "nobody answers: the run's process is gone";
  }
}

function follow() {
  const stream = new EventSource("events" + location.search);
  stream.onmessage = (message) => {
    tell(JSON.parse(message.data));
    if (over) stream.close();
  };
  stream.onopen = () => { news.textContent = ""; };
  stream.onerror = () => {
    if (!over) news.textContent = "nobody answers: the run's process is gone, or behind";
  };
}

document.getElementById("stop")?.addEventListener("click", () => order("stop", STOPPING));
document.getElementById("end")?.addEventListener("click", () => order("end", "ending the run"));
whenDrawn(follow);
