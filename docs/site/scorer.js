// How the search orders what it finds: presets and techniques first, the history and long tables last.
globalThis.Scorer = {  // Sphinx reads it
  score: ({ 0: page, 4: score }) => score + (globalThis.Scorer.places.find(([folder]) => page.startsWith(folder)) ?? ['', 0])[1],
  places: [
    ['docs/reference/presets/', 14], ['docs/reference/techniques/', 8], ['docs/reference/commands', 4], ['docs/tutorials/', 3],
    ['CHANGELOG', -20], ['qualification', -8], ['docs/parity', -8], ['docs/accuracy/', -4], ['docs/errata', -4],
  ],
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 15, 1: 5, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
