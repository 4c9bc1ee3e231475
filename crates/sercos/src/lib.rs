//! Sercos III, cyclic part: telegrams, communication phases, a master and simulated slaves.
