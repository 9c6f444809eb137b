"""One module a subcommand of `c2nav`; `app.cli` lists them."""
