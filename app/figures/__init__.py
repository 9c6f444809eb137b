"""Figures for papers: vector text, pictures at their recorded size, a recipe beside each."""
