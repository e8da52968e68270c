// How the search orders what it finds: names of presets, techniques, commands and options first, the history last.
globalThis.Scorer = {  // Sphinx reads it
  score({ 0: page, 4: score, 6: kind }) {
    const { kinds, places } = globalThis.Scorer;
    const place = places.find(([folder]) => page.startsWith(folder));
    return score + (kinds[kind] ?? 0) + (place ? place[1] : 0);
  },
  kinds: { object: 20, title: 10 },
  places: [
    ['docs/reference/presets/', 4], ['docs/errors', 6], ['docs/tutorials/', 2], ['CHANGELOG', -20], ['qualification', -8],
    ['src/', -6], ['docs/parity', -8], ['docs/accuracy/', -4], ['docs/errata', -4],
  ],
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
