"""The code blocks of docs/python.md run, one after the other."""
import re


def test_the_page_runs(root, tmp_path, monkeypatch, capsys):
    page = (root / "docs/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)
    assert len(blocks) >= 10
    monkeypatch.chdir(tmp_path)
    (tmp_path / "problems").symlink_to(root / "problems")
    names = {"__name__": "page"}
    import elamin

    names["elamin"] = elamin
    for block in blocks:
        line = page[: page.index(block)].count("\n")
        exec(compile("\n" * line + block, str(root / "docs/python.md"), "exec"), names)
    out = capsys.readouterr().out
    assert "branch:1 0.01284566" in out and "unstable" in out
    assert 'beam.b.diametre: unknown key' in out and 'did you mean "diameter"?' in out
    assert (tmp_path / "figure.svg").exists()
    assert names["loads"][-1] == 1 and names["sags"][-1] < 0
