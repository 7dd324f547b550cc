"""The files that come with the package are found, however it was installed."""

from pathlib import Path
import shutil
import subprocess
import sys

import pytest

from tendon_ros.base import resources

LOOK = 'from tendon_ros.base.resources import config_path; print(config_path("instruments"))'
PACKAGE = Path(resources.__file__).parent.parent


def place_package(folder: Path) -> None:
    """Put the part of the package that finds files into a folder, as an installer would."""
    for name in ('__init__.py', 'base'):
        source, target = PACKAGE / name, folder / 'tendon_ros' / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns('__pycache__'))
        else:
            shutil.copy(source, target)


def look_from(folder: Path, **env: str) -> subprocess.CompletedProcess[str]:
    """Ask a package that stands in a folder for its instruments."""
    return subprocess.run(
        [sys.executable, '-P', '-c', LOOK],
        env={'PYTHONPATH': str(folder), **env},
        cwd='/',
        text=True,
        capture_output=True,
        check=False,
    )


@pytest.mark.parametrize('site', ['lib/python3.12/site-packages', 'local/lib/dist-packages', '.'])
def test_installed_under_a_prefix(tmp_path, site):
    place_package(tmp_path / site)
    wanted = tmp_path / 'share/tendon_ros/config/instruments'
    wanted.mkdir(parents=True)
    done = look_from(tmp_path / site)
    assert Path(done.stdout.strip()) == wanted, done.stderr


def test_a_foreign_config_in_site_packages_is_not_ours(tmp_path):
    site = tmp_path / 'lib/site-packages'
    place_package(site)
    (site / 'config/instruments').mkdir(parents=True)
    wanted = tmp_path / 'share/tendon_ros/config/instruments'
    wanted.mkdir(parents=True)
    assert Path(look_from(site).stdout.strip()) == wanted


def test_symlinked_build_leads_to_the_checkout(tmp_path):
    checkout, build = tmp_path / 'checkout', tmp_path / 'build'
    place_package(checkout)
    wanted = checkout / 'config/instruments'
    wanted.mkdir(parents=True)
    (checkout / 'resource').mkdir()
    (checkout / 'resource/tendon_ros').touch()
    build.mkdir()
    (build / 'tendon_ros').symlink_to(checkout / 'tendon_ros')
    assert Path(look_from(build).stdout.strip()) == wanted


def test_ament_prefixes_come_last(tmp_path):
    place_package(tmp_path / 'elsewhere/python')
    wanted = tmp_path / 'overlay/share/tendon_ros/config/instruments'
    wanted.mkdir(parents=True)
    prefixes = f'{tmp_path}/underlay:{tmp_path}/overlay'
    done = look_from(tmp_path / 'elsewhere/python', AMENT_PREFIX_PATH=prefixes)
    assert Path(done.stdout.strip()) == wanted, done.stderr


def test_without_config_the_error_names_the_mend(tmp_path):
    place_package(tmp_path / 'bare')
    done = look_from(tmp_path / 'bare')
    assert done.returncode == 1
    assert 'install the package again' in done.stderr.splitlines()[-1]


def test_an_unknown_name_lists_what_exists():
    with pytest.raises(
        resources.ResourceError, match=r'no_such\.yaml: does not exist; .*paper_rig'
    ):
        resources.config_path('instruments/no_such.yaml')


def test_files_that_come_with_the_package_are_known_by_name(tmp_path):
    own = tmp_path / 'mine.yaml'
    own.write_text('{}')
    assert resources.installed(own, 'imports') == own
    assert resources.installed('davinci_grasper', 'imports') == resources.config_path(
        'imports/davinci_grasper.yaml'
    )
    assert resources.installed('davinci_grasper.yaml', 'imports') is not None
    assert resources.installed('nobody', 'imports') is None
    assert resources.installed(tmp_path / 'davinci_grasper', 'imports') is None
