// What is common to all views of the recorder: its language, and what of the page they change.
import { element } from './dom.js';
import { wordsOf } from './words.js';

const content = document.getElementById('page');
const notice = document.getElementById('notice');
const languageButton = document.getElementById('language');

let language = 'en';
let view = async () => {}; // draws the present view

export const presentLanguage = () => language;
export const words = (key, values) => wordsOf(language)(key, values);

// The browser's own form of the language: en-GB, de-AT.
const locale = () => navigator.languages.find((name) => name.startsWith(language)) ?? language;

export const dateOf = (ms) => new Date(ms).toLocaleString(locale(), { dateStyle: 'medium', timeStyle: 'short' });

export const number = (value, digits = 0) =>
  value.toLocaleString(locale(), { minimumFractionDigits: digits, maximumFractionDigits: digits });

export const heading = (key) => element('h2', { tabindex: '-1' }, words(key));

export function button(key, onclick, attributes = {}) {
  return element('button', { type: 'button', onclick, ...attributes }, words(key));
}

export function say(text) {
  notice.textContent = text;
}

// Shows a view and gives its heading the focus, so that a screen reader begins there. next(...values): its elements.
export async function show(next, ...values) {
  view = () => show(next, ...values);
  const elements = await next(...values);
  content.replaceChildren(...elements);
  document.documentElement.lang = language;
  document.getElementById('title').textContent = 'Macadam';
  document.title = `${words('title')} – Macadam`;
  languageButton.textContent = words('other_language');
  languageButton.lang = language === 'de' ? 'en' : 'de';
  content.querySelector('h2')?.focus();
}

// Takes the language that was chosen before, or the browser's, and lets the driver change it. kept: remembers a choice.
export function speak(chosen, kept) {
  language = chosen ?? (navigator.language.startsWith('de') ? 'de' : 'en');
  languageButton.onclick = async () => {
    language = language === 'de' ? 'en' : 'de';
    await kept(language);
    await view();
  };
}
