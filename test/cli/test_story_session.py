"""The story is told from what `tendon diagnose` leaves, which sees bags and the stand's file."""

import argparse

import yaml

from tendon_ros.bags.reader import read_recording
from tendon_ros.cli import story_session, verb_diagnose
from tendon_ros.model.instrument_file import load_instrument, save_instrument
from tendon_ros.model.paper import withheld_rig

NOTHING = """{"schema": 1, "verdict": "unexplained", "gap": [], "where": [], "causes": [],
"candidates": [], "unexplained": {"probability": 0.9}}"""


def test_diagnosis_is_asked_before_anything_withheld_is_written(tmp_path, monkeypatch, capsys):
    seen = []

    def diagnosed(args):
        seen.append(args)
        recording = read_recording(args.bag[0])
        assert 'pulley/pulley_3/velocity' not in recording
        assert not (tmp_path / 'withheld.yaml').exists()
        (tmp_path / 'diagnosis.json').write_text(NOTHING)
        save_instrument(load_instrument(args.instrument), tmp_path / 'instrument.yaml')

    monkeypatch.setattr(verb_diagnose, 'run', diagnosed)
    monkeypatch.setattr(withheld_rig, 'PLANS', withheld_rig.PLANS[:1])
    page = story_session.tell(tmp_path)
    [args] = seen
    assert args.instrument == withheld_rig.STAND
    assert args.withhold == []
    # what the command takes by default, whatever options it has
    parser = argparse.ArgumentParser()
    verb_diagnose.add_arguments(parser)
    usual = vars(parser.parse_args(['bag', '--instrument', 'file', '--out', 'folder']))
    asked = {'bag', 'instrument', 'out'}
    assert {k: v for k, v in vars(args).items() if k not in asked} == {
        k: v for k, v in usual.items() if k not in asked
    }
    assert '<html' in page.read_text()
    withheld = yaml.safe_load((tmp_path / 'withheld.yaml').read_text())['effects']
    assert {'pretension', 'tension_friction', 'stribeck_friction'} <= {
        use['effect'] for use in withheld
    }
    assert '0 of 5 withheld effects are named' in capsys.readouterr().out
