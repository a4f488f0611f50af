"""Chains of masses on a shaft: their equations, natural vibrations, and what torques make of them."""
