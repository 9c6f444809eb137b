// The one copy of the state in a page: filled by the event stream, read by every element.

const listeners = new Set();
let stream = null;
let retry_ms = 500;

export const state = {};
export const tab = `page ${Math.floor(Math.random() * 900 + 100)}`;
export const link = { connected: false };

/** The address of something of ours; relative, so that a path prefix works. */
export const at = (path) => new URL(path, document.baseURI).href;

/** Call `listener(state, changed)` now and after every change; returns how to stop. */
export function subscribe(listener) {
  listeners.add(listener);
  if (state.schema) listener(state, new Set(Object.keys(state)));
  return () => listeners.delete(listener);
}

function tell(changed) {
  for (const listener of [...listeners]) {
    try {
      listener(state, changed);
    } catch (error) {
      console.error(error);
    }
  }
}

/** Follow the server; a lost connection is taken up again by itself. */
export function follow() {
  stream = new EventSource(at("api/events"));
  stream.addEventListener("state", (event) => {
    const sections = JSON.parse(event.data);
    Object.assign(state, sections);
    retry_ms = 500;
    if (!link.connected) {
      link.connected = true;
      sections.link = true;
    }
    tell(new Set(Object.keys(sections)));
  });
  stream.addEventListener("error", () => {
    link.connected = false;
    tell(new Set(["link"]));
    if (stream.readyState === EventSource.CLOSED) {
      setTimeout(follow, retry_ms);
      retry_ms = Math.min(retry_ms * 2, 8000);
    }
  });
}

const ANSWERING = new Set(["press", "arrange", "tie", "none", "take_back", "clear", "commit"]);

// Commands go out one after the other: two keys in quick succession must arrive in that order.
let line = Promise.resolve();

/** Send a command; an answer carries the id of the state that it was given to. */
export function send(type, fields = {}) {
  const body = { type, tab, ...fields };
  if (ANSWERING.has(type)) body.id = state.id;
  line = line.then(() => post(body));
  return line;
}

async function post(body) {
  try {
    const answer = await fetch(at("api/commands"), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    if (answer.status === 409) toast("That question has moved on; look again");
    else if (!answer.ok) toast(`Not understood (${answer.status})`);
    return answer.ok;
  } catch {
    toast("No connection to the inspector");
    return false;
  }
}

/** Say something once, in this page only. */
export function toast(text, fault = true) {
  window.dispatchEvent(new CustomEvent("c2-toast", { detail: { text, fault } }));
}

export const image = (sha) => at(`api/image/${sha}.jpg`);
