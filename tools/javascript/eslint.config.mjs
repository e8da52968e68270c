// What `make lint` asks of all JavaScript: ESLint's own recommendations, and a few more. Types are TypeScript's part.

import { createRequire } from 'node:module';

const require = createRequire(new URL('../../build/jslint/', import.meta.url));
const js = require('@eslint/js');
const globals = require('globals');

export default [
  // an emitted module is checked where it was just emitted, in build/jslint/emitted, not its snapshot
  { ignores: ['.venv/', 'build/*', '!build/jslint/', 'build/jslint/node_modules/', 'dist/', 'out/', 'tests/snapshots/'] },
  js.configs.recommended,
  {
    languageOptions: { globals: { ...globals.browser, ...globals.node, dumpedShaders: 'readonly' } },
    linterOptions: { reportUnusedDisableDirectives: 'error' },
    rules: {
      'eqeqeq': ['error', 'always', { null: 'ignore' }],
      'no-unused-vars': ['error', { ignoreRestSiblings: true }],
      'no-var': 'error',
      'object-shorthand': 'error',
      'prefer-const': ['error', { destructuring: 'all' }],
    },
  },
];
