"use strict";
// The slider of a report: one time for all of its runs.

const slider = document.getElementById("time");
const play = document.getElementById("play");
const LONGEST_SHOW = 30; // s
let playing = null;

function look(time) {
  for (let run = 0; run < page.runs.length; run++) {
    const times = source("ticks", run).data.time;
    if (times.length) showRow(run, rowAt(times, time));
    source("now", run).data = {time: [time]};
  }
  document.getElementById("clock").textContent = `${time.toFixed(2)} s`;
}

function stopPlaying() {
  cancelAnimationFrame(playing);
  playing = null;
  play.textContent = "▶";
}

function startPlaying() {
  const end = Number(slider.max), from = Number(slider.value) >= end ? 0 : Number(slider.value);
  const pace = Math.max(1, end / LONGEST_SHOW) / 1000, began = performance.now();
  const step = (now) => {
    const time = Math.min(from + Math.max(now - began, 0) * pace, end);
    slider.value = time;
    look(time);
    if (time < end) playing = requestAnimationFrame(step); else stopPlaying();
  };
  play.textContent = "❚❚";
  playing = requestAnimationFrame(step);
}

slider.addEventListener("input", () => look(Number(slider.value)));
play.addEventListener("click", () => (playing === null ? startPlaying() : stopPlaying()));
whenDrawn(() => look(Number(slider.value)));
