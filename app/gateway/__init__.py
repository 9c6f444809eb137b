"""The inspector's only public port: viser's page, our assets, the API and the event stream."""
