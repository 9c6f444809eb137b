"""Judgements of people: events, store, queues, agreement."""
