# Two commands: `make run` opens the inspector, `make test` checks everything.
.PHONY: run setup test check tests slow bench clean

run: setup  ## open the inspector on a built-in episode
	.venv/bin/c2nav inspect builtin

setup:  ## .venv with c2nav in .venv/bin, system libraries included
	@.ci/setup run

test:  ## everything that must hold
	@.ci/setup test
	@$(MAKE) --no-print-directory check tests

check:  ## style, types, import contracts
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/pyright
	.venv/bin/lint-imports

tests:
	.venv/bin/pytest -n 2 --dist loadfile -m "not slow"

slow:  ## campaigns: many kills, many planted answers
	.venv/bin/pytest -n 2 -m slow

bench:  ## the benchmark tables of this machine
	.venv/bin/c2nav bench

clean:
	rm -rf .venv .tools
