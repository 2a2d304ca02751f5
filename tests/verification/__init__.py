"""One wave against closed forms, independent models and itself refined, with figures asserted."""
