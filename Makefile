# make preview  a page that shows skin_ear, or MATERIAL=file.toml, while its files change
# make demo   emit every example for every target into out/demo and compile all of it
# make test   the tests, but the slow ones (make test-long)      make lint   ruff, mypy, import contracts, tsc, eslint
# make gallery  the example scenes' pictures, and docs/gallery.md
# make heroes  large pictures with surroundings beside path traced ones, hours on two cores: docs/heroes.md
# make stability  what fails in the published techniques and holds in ours: docs/stability.md
# make bake   bakes two meshes, and docs/bake.md with pictures beside the exact reference
# make accuracy   error against cost of everything, on two cores 110 minutes: docs/accuracy.md and docs/accuracy/*.md
# make site   a first page with a live demo, the documents and the playground, static: build/site/index.html
# make suites SUITES=FOLDER [ONLY=gles2,piglit]  shader suites of others, which the folder has: docs/suites.md
# make fuzz   random programs and files for FUZZ_MINUTES (10)
# make bench  the benchmarks   make bench-gpu  what shaders cost on this GPU, emitted and by hand
# make setup  what the others need, done once: .venv, system packages, compilers
# make vscode  the extension for VS Code, build/vscode/sssgen.vsix
# make dist   the source distribution and the wheel, in dist/, and the tests of both in an empty environment
# make engines  Godot 4.6 in build/engines, 1.2 GB, and Firefox, as root: make test-long then runs the shaders in them

PYTHON := $(shell for p in python3 python3.14 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)
BIN := .venv/bin
BUNDLED_PACKAGES := three@0.187.0 esbuild@0.28.2 pyodide@314.0.7
NODE_PACKAGES := webgpu@0.6.2 playcanvas@2.23.3 wesl@0.7.31 @babylonjs/core@9.34.0 gltf-validator@2.0.0-dev.3.10 $(BUNDLED_PACKAGES)
# Babylon.js is thousands of files: a page loads one.
BABYLON_BUNDLE := src/sssgen/run/backends/babylon_bundle.js
# What the preview's page imports, as one file: the wheel has it.
PREVIEW_BUNDLE := src/sssgen/preview/library_bundle.js
# What checks the JavaScript; editors/vscode/package.json has the last two, too.
LINT_PACKAGES := typescript@7.0.2 eslint@10.15.0 @eslint/js@10.0.1 globals@17.14.0 @types/node@24.19.2 @types/three@0.187.0 \
	@types/vscode@1.91.0 vscode-languageclient@11.0.0 @vscode/vsce@4.1.0
JSLINT := build/jslint/node_modules/.bin
# The index has its source only: built here once, for two minutes, and kept apart from .venv.
BUILT_PACKAGES := compushady==0.17.5
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

MATERIALS := $(foreach folder,$(wildcard examples/*),$(wildcard $(folder)/$(notdir $(folder)).toml)) \
	$(addprefix examples/bake/,wax_distance.toml wax_map.toml wax_depth.toml ice_baked.toml) \
	examples/marble_idol/marble_idol_relit.toml examples/skin_ear/skin_ear_relit.toml

export PYTHONUTF8 := 1
# Without stored bytecode, each of the hundreds of processes that the tests start would compile all of sssgen.
unexport PYTHONDONTWRITEBYTECODE
.DELETE_ON_ERROR:
.PHONY: setup accuracy bake demo preview first test test-long fuzz lint bench bench-gpu gallery heroes stability suites engines site vscode dist clean

setup: .venv/done build/node/done build/preview/library.js

DEMO := out/demo
demo: first setup
	rm -rf $(DEMO)
	@echo "every example, for every target, in both forms:"
	$(BIN)/sssgen emit $(MATERIALS) --target all --form shader -o $(DEMO)
	$(BIN)/sssgen emit $(MATERIALS) --target all --form functions -o $(DEMO)
	@echo "every compiler that this machine has, on all of it, for a minute or two:"
	$(BIN)/sssgen check $(DEMO)

# A shader within seconds, in a small environment: the setup of the whole takes minutes, the first time.
FIRST := build/first/bin
first:
	@test -n "$(PYTHON)" || { echo "Python 3.11 or later is needed"; exit 1; }
	@{ test -x $(FIRST)/sssgen || { $(PYTHON) -m venv build/first && $(FIRST)/python -m pip --quiet install --editable .; }; } \
		&& $(FIRST)/sssgen emit ice --target threejs -o $(DEMO) \
		|| { rm -rf build/first; echo "the first shader follows after the setup, which installs what it needs"; }
	@test -e .venv/done || echo "installing what the rest of the demo needs, once, for minutes: packages, compilers"

# In a small environment too, or in the whole one where it exists.
MATERIAL ?= skin_ear
VIEW := $(if $(wildcard .venv/done),$(BIN),build/view/bin)
preview: $(VIEW)/sssgen build/preview/library.js
	$(VIEW)/sssgen preview $(MATERIAL)

build/view/bin/sssgen: pyproject.toml
	@test -n "$(PYTHON)" || { echo "Python 3.11 or later is needed"; exit 1; }
	@echo "installing what the preview needs, once, for a minute"
	$(PYTHON) -m venv build/view
	build/view/bin/python -m pip --disable-pip-version-check --quiet install --editable '.[preview]'
	@touch $@

# Each of the two workers has one core.
test test-long: export OPENBLAS_NUM_THREADS := 1

test: setup
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test-long: setup .venv/docs build/vscode/done
	$(BIN)/python -m pytest -n 2 --dist loadfile -m slow

FUZZ_MINUTES ?= 10
fuzz: setup
	$(BIN)/python tests/fuzz/long.py --minutes $(FUZZ_MINUTES)

lint: setup build/jslint/done
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict src qualification
	$(BIN)/lint-imports
	rm -rf build/jslint/emitted build/jslint/declared && mkdir build/jslint/declared
	$(BIN)/sssgen emit $(MATERIALS) --target threejs,babylonjs,playcanvas -o build/jslint/emitted >/dev/null
	$(BIN)/sssgen emit $(MATERIALS) --target threejs,babylonjs,playcanvas --form functions -o build/jslint/emitted >/dev/null
	mv build/jslint/emitted/*.d.*ts build/jslint/declared
	$(JSLINT)/tsc -p tools/javascript
	@# The emitted declarations, too: there the engines' own, which contradict each other, have errors.
	! $(JSLINT)/tsc -p tools/javascript --skipLibCheck false | grep '^build/jslint/declared/'
	$(JSLINT)/eslint -c tools/javascript/eslint.config.mjs . build/jslint/emitted

bench: setup
	for file in $(wildcard benchmarks/bench_*.py); do $(BIN)/python $$file || exit 1; done

bench-gpu: setup
	$(BIN)/python benchmarks/gpu.py
	$(BIN)/python benchmarks/gpu_passes.py

gallery: setup
	$(BIN)/python docs/gallery.py
	$(BIN)/python docs/before_after.py

heroes: setup
	$(PIP) install --editable '.[heroes]'
	$(BIN)/python docs/heroes.py

stability: setup
	$(BIN)/python -m qualification.pages.stability
	$(BIN)/python -m qualification.pages.safety

SUITES ?= ../suites
suites: setup
	$(BIN)/python -m qualification.suites $(SUITES) --suites "$(ONLY)" --write

bake: setup
	$(BIN)/python docs/bake.py

accuracy: setup
	$(BIN)/python docs/accuracy.py

site: setup .venv/docs
	$(BIN)/python docs/site/build_site.py build/site

vscode: build/vscode/done
	rm -rf build/vscode/extension
	cp -R editors/vscode build/vscode/extension
	node build/vscode/extension/pack.mjs build/vscode/extension build/vscode/sssgen.vsix

# What packs and tests the extension, in the versions of its package.json.
build/vscode/done: editors/vscode/package.json | build/system
	@mkdir -p build/vscode
	cp editors/vscode/package.json build/vscode/package.json
	npm install --prefix build/vscode --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@

engines: build/engines/godot/usr/bin/godot

build/engines/godot/usr/bin/godot:
	sh tools/install_engines.sh build/engines/godot

# What it needs is kept apart from .venv, as nothing else needs it.
dist: setup build/release/done
	rm -rf dist
	build/release/bin/pyproject-build --outdir dist
	build/release/bin/twine check --strict dist/*
	DIST=dist $(BIN)/python -m pytest -m "" tests/project/test_packaging.py tests/project/test_distribution_name.py

build/release/done: Makefile | build/system
	$(PYTHON) -m venv build/release
	build/release/bin/python -m pip --disable-pip-version-check --quiet install 'build>=1.2' 'twine>=6'
	@touch $@

clean:
	rm -rf .venv build out dist

build/system: tools/install_system.sh
	@test -n "$(PYTHON)" || { echo "Python 3.11 or later is needed"; exit 1; }
	sh tools/install_system.sh $(PYTHON)
	@mkdir -p build && touch $@

.venv/pyvenv.cfg: | build/system
	$(PYTHON) -m venv .venv

build/wheels/done: Makefile | .venv/pyvenv.cfg
	@test -e $@ || echo "building $(BUILT_PACKAGES): about two minutes, once"
	$(PIP) wheel --no-deps --find-links build/wheels --wheel-dir build/wheels $(BUILT_PACKAGES)
	@touch $@

.venv/done: pyproject.toml build/wheels/done | .venv/pyvenv.cfg
	$(PIP) install --find-links build/wheels --editable '.[dev]'
	@touch $@

# What the site needs: beside the development's packages, as nothing else needs it.
.venv/docs: pyproject.toml .venv/done
	$(PIP) install --editable '.[docs]'
	@touch $@

build/node/done: Makefile $(BABYLON_BUNDLE) | build/system
	npm install --prefix build/node --no-audit --no-fund --loglevel=error $(NODE_PACKAGES)
	NODE_PATH=build/node/node_modules build/node/node_modules/.bin/esbuild $(BABYLON_BUNDLE) --bundle --format=esm \
		--outfile=build/node/babylon.js --log-level=error
	@touch $@

build/jslint/done: Makefile | build/system
	npm install --prefix build/jslint --ignore-scripts --no-audit --no-fund --loglevel=error $(LINT_PACKAGES)
	@touch $@

# Apart from build/node, as whoever only looks at a material needs no more than this.
NPM_BY_SYSTEM := $(if $(shell command -v npm),,build/system)
build/preview/library.js: $(PREVIEW_BUNDLE) Makefile | $(NPM_BY_SYSTEM)
	npm install --prefix build/preview --no-audit --no-fund --loglevel=error $(BUNDLED_PACKAGES)
	cp build/preview/node_modules/three/LICENSE build/preview/three.LICENSE
	NODE_PATH=build/preview/node_modules build/preview/node_modules/.bin/esbuild $(PREVIEW_BUNDLE) --bundle --minify \
		--format=esm --legal-comments=inline --outfile=$@ --log-level=error
